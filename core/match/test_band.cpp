// SPDX-License-Identifier: Apache-2.0
#include "core/match/test_band.h"

#include <cstddef>

#include "core/match/bit_rows.h"

namespace boresight {
namespace {

// The word after the last is read when rows are shifted by less than a byte.
int strideFor(int side, int words) { return (side + 63) / 64 * 8 + 8 * (words + 1); }

// Behind the rows that hold pixels there are as many zero rows as rows of offsets, since the base
// of a list of pixels moves down with the row of offsets.
int rowsFor(int side) { return side + 2 * TestBand::kOffsetRows; }

}  // namespace

void TestBand::create(int max_side, int max_words, Arena& arena) {
  bytes_ = arena.allocate<std::uint8_t>(static_cast<std::size_t>(strideFor(max_side, max_words)) *
                                        static_cast<std::size_t>(rowsFor(max_side)));
}

void TestBand::shape(int side, int words) {
  stride_ = strideFor(side, words);
  side_ = side;
  std::uint8_t* zeros = bytes_.data() + zeroOffset();
  for (int i = 0; i < stride_ * kOffsetRows; ++i) zeros[i] = 0;
}

void TestBand::load(const BitImage& test_edges, int x, int y) {
  const int words = stride_ / 8;
  const int rows = side_ + kOffsetRows;
  for (int r = 0; r < rows; ++r) {
    std::uint8_t* to = bytes_.data() + stride_ * r;
    if (y + r >= test_edges.height) {
      for (int i = 0; i < stride_; ++i) to[i] = 0;
      continue;
    }
    for (int word = 0; word < words; ++word) {
      storeWord(to + 8 * word, byteOrdered(pixelsAt(test_edges, x + 64 * word, y + r)));
    }
  }
}

}  // namespace boresight
