// SPDX-License-Identifier: Apache-2.0
#include "core/match/edge_pixels.h"

#include <bit>
#include <cstddef>

#include "core/base/nth.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

/// Pixels u of a word with u % shifts == shift.
std::uint64_t shiftMask(int shift, int shifts) {
  std::uint64_t mask = std::uint64_t{1} << shift;
  for (int period = shifts; period < 64; period *= 2) mask |= mask << period;
  return mask;
}

}  // namespace

void EdgePixels::create(int capacity, Arena& arena) {
  // A row always fits: it is the least capacity of a list.
  const int least = kMaxTemplateSide_px;
  const int size = (capacity > least ? capacity : least) + kMostShifts * (kPixelGroup - 1);
  offsets_ = arena.allocate<std::int32_t>(size);
}

int EdgePixels::countRows(const TemplateView& view, int shifts, int first_row) {
  const int room = static_cast<int>(offsets_.size()) - kMostShifts * (kPixelGroup - 1);
  std::array<std::uint64_t, kMostShifts> masks{};
  for (int shift = 0; shift < shifts; ++shift) {
    nth(masks, shift) = shiftMask(shift, shifts);
  }
  count_.fill(0);
  int total = 0, v = first_row;
  for (; v < view.side_px; ++v) {
    std::array<int, kMostShifts> in_row{};
    int row_total = 0;
    for (int word = 0; 64 * word < view.side_px; ++word) {
      const std::uint64_t bits = edgeWord(view, v, word);
      if (bits == 0) continue;
      row_total += countOnes(bits);
      for (std::size_t k = 0; k < static_cast<std::size_t>(shifts); ++k) {
        in_row[k] += countOnes(bits & masks[k]);
      }
    }
    if (total + row_total > room) break;
    total += row_total;
    for (std::size_t k = 0; k < kMostShifts; ++k) count_[k] += in_row[k];
  }
  return v;
}

int EdgePixels::list(const TemplateView& view, const TestBand& band, int first_row) {
  const int shifts = band.shifts();
  const int end_row = countRows(view, shifts, first_row);
  std::array<int, kMostShifts> next{};
  int first = 0;
  for (std::size_t k = 0; k < kMostShifts; ++k) {
    first_[k] = next[k] = first;
    first += paddedPixels(count_[k]);
  }
  for (int v = first_row; v < end_row; ++v) {
    for (int word = 0; 64 * word < view.side_px; ++word) {
      for (std::uint64_t bits = edgeWord(view, v, word); bits != 0; bits &= bits - 1) {
        const int u = 64 * word + std::countr_zero(bits);
        int& at = nth(next, u % shifts);
        nth(offsets_, at++) = band.offsetOf(u, v);
      }
    }
  }
  for (std::size_t k = 0; k < kMostShifts; ++k) {
    for (; next[k] < first_[k] + paddedPixels(count_[k]); ++next[k]) {
      nth(offsets_, next[k]) = band.zeroOffset();
    }
  }
  return end_row;
}

PixelList EdgePixels::pixels(int shift) const {
  const std::size_t k = static_cast<std::size_t>(shift);
  return {offsets_.data() + first_[k], paddedPixels(count_[k]), planesFor(count_[k]), shift};
}

}  // namespace boresight
