// SPDX-License-Identifier: Apache-2.0
#include "core/match/test_band.h"

#include <algorithm>
#include <cstddef>

#include "core/match/bit_counters.h"
#include "core/match/bit_rows.h"

namespace boresight {
namespace {

constexpr int kMostCopies = 4;
constexpr int kCacheBytes = 24 * 1024;  ///< what copies may take up

// One word more than is asked for is read when rows are shifted by less than a byte.
int strideFor(int side, int words) { return 8 * ((side + 63) / 64 + words + 1); }

int rowsFor(int side) { return side + TestBand::kOffsetRows; }

// Behind the rows that hold pixels there are as many zero rows as rows of offsets, since the base
// of a list of pixels moves down with the row of offsets; the last of them is read beyond its end.
int zeroBytesFor(int stride) { return stride * TestBand::kOffsetRows + 8 * kWordPadding; }

}  // namespace

void TestBand::create(int max_side, int max_words, Arena& arena) {
  const int stride = strideFor(max_side, max_words);
  const int bytes = std::max(stride * rowsFor(max_side), kCacheBytes) + zeroBytesFor(stride);
  bytes_ = arena.allocate<std::uint8_t>(static_cast<std::size_t>(bytes));
}

void TestBand::shape(int side, int words) {
  side_ = side;
  stride_ = strideFor(side, words);
  copy_bytes_ = stride_ * rowsFor(side);
  copies_ = 1;
  while (copies_ < kMostCopies && 2 * copies_ * copy_bytes_ <= kCacheBytes) copies_ *= 2;
  std::fill_n(bytes_.begin() + zeroOffset(), zeroBytesFor(stride_), std::uint8_t{0});
}

void TestBand::load(const BitImage& test_edges, int x, int y) {
  const int words = stride_ / 8;
  for (int r = 0; r < rowsFor(side_); ++r) {
    std::uint8_t* to = bytes_.data() + stride_ * r;
    const bool exists = y + r < test_edges.height;
    std::uint64_t next = exists ? pixelsAt(test_edges, x, y + r) : 0;
    for (int word = 0; word < words; ++word, to += 8) {
      const std::uint64_t here = next;
      next = exists && word + 1 < words ? pixelsAt(test_edges, x + 64 * (word + 1), y + r) : 0;
      storeWord(to, byteOrdered(here));
      for (int copy = 1; copy < copies_; ++copy) {
        const int shift = copy * shifts();
        storeWord(to + copy * copy_bytes_, byteOrdered((here >> shift) | (next << (64 - shift))));
      }
    }
  }
}

}  // namespace boresight
