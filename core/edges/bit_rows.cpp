// SPDX-License-Identifier: Apache-2.0
#include "core/edges/bit_rows.h"

#include <algorithm>
#include <bit>

namespace boresight {
namespace {

/// ORs every word with the row moved by `shift` (1 ... 63) pixels to both sides.
void spreadSideways(std::uint64_t* row, int words, int shift) {
  std::uint64_t before = 0;
  for (int w = 0; w < words; ++w) {
    const std::uint64_t word = row[w];
    const std::uint64_t after = w + 1 < words ? row[w + 1] : 0;
    row[w] = word | (word << shift) | (word >> shift) | (before >> (64 - shift)) |
             (after << (64 - shift));
    before = word;
  }
}

/// Bits 0, 2, 4, ... of `word` side by side in the lower half.
std::uint64_t evenBits(std::uint64_t word) {
  word &= 0x5555555555555555U;
  word = (word | (word >> 1)) & 0x3333333333333333U;
  word = (word | (word >> 2)) & 0x0F0F0F0F0F0F0F0FU;
  word = (word | (word >> 4)) & 0x00FF00FF00FF00FFU;
  word = (word | (word >> 8)) & 0x0000FFFF0000FFFFU;
  return (word | (word >> 16)) & 0x00000000FFFFFFFFU;
}

}  // namespace

void dilateRow(const BitImage& mask, int y, int margin_px, std::uint64_t* out) {
  const int words = mask.words_per_row;
  std::fill(out, out + words, 0);
  const int last = std::min(y + margin_px, mask.height - 1);
  for (int near = std::max(y - margin_px, 0); near <= last; ++near) {
    const std::uint64_t* row = mask.row(near);
    for (int w = 0; w < words; ++w) out[w] |= row[w];
  }
  // A run that the border of the image cut to one side of its origin is reach + 1 pixels long; a
  // larger shift would leave gaps.
  for (int reach = 0; reach < margin_px;) {
    const int shift = std::min(reach + 1, margin_px - reach);
    spreadSideways(out, words, shift);
    reach += shift;
  }
}

void poolRows(const BitImage& fine, int first_row, int last_row, BitImage& coarse) {
  for (int y = first_row; y < last_row; ++y) {
    const std::uint64_t* upper = fine.row(2 * y);
    const std::uint64_t* lower = fine.row(std::min(2 * y + 1, fine.height - 1));
    std::uint64_t* out = coarse.row(y);
    for (int w = 0; w < coarse.words_per_row; ++w) out[w] = 0;
    for (int w = 0; w < fine.words_per_row; ++w) {
      const std::uint64_t pair = upper[w] | lower[w];
      out[w >> 1] |= evenBits(pair | (pair >> 1)) << ((w & 1) * 32);
    }
  }
}

std::int32_t countBits(const BitImage& image) {
  std::int32_t count = 0;
  for (const std::uint64_t word : image.words) count += std::popcount(word);
  return count;
}

}  // namespace boresight
