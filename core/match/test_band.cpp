// SPDX-License-Identifier: Apache-2.0
#include "core/match/test_band.h"

#include <algorithm>
#include <cstddef>

#include "core/match/bit_counters.h"
#include "core/match/pixel_words.h"

namespace boresight {
namespace {

constexpr int kCacheBytes = 64 * 1024;  ///< largest size of all copies
constexpr int kMostWords = 24;          ///< of a row: a search needs 19

// One word more than requested is read when rows are shifted by less than a byte.
int wordsFor(int side, int words) { return (side + 63) / 64 + words + 1; }

// Loading a band costs the rows of template and offsets together, so more rows of offsets are
// better until they evict the rest from the cache.
constexpr int kSmallSide = 128;
int offsetRowsFor(int side) { return side <= kSmallSide ? 64 : 32; }

int pixelBytesFor(int side, int stride) { return stride * (side + offsetRowsFor(side)); }

// The rows with pixels are followed by one zero row per row of offsets, since the base of a list of
// pixels moves down with the row of offsets; the last of them is read beyond its end.
int zeroBytesFor(int side, int stride) { return stride * offsetRowsFor(side) + 8 * kWordPadding; }

int bytesFor(int side, int words) {
  const int stride = 8 * wordsFor(side, words);
  return std::max(pixelBytesFor(side, stride), kCacheBytes) + zeroBytesFor(side, stride);
}

}  // namespace

void TestBand::create(int max_side, int max_words, Arena& arena) {
  const int bytes =
      std::max(bytesFor(max_side, max_words), bytesFor(std::min(max_side, kSmallSide), max_words));
  bytes_ = arena.allocate<std::uint8_t>(bytes);
}

void TestBand::shape(int side, int words, int most_copies) {
  side_ = side;
  words_ = wordsFor(side, words);
  stride_ = 8 * words_;
  offset_rows_ = offsetRowsFor(side);
  copy_bytes_ = pixelBytesFor(side, stride_);
  copies_ = 1;
  while (copies_ < most_copies && 2 * copies_ * copy_bytes_ <= kCacheBytes) copies_ *= 2;
  std::fill_n(bytes_.begin() + zeroOffset(), zeroBytesFor(side, stride_), std::uint8_t{0});
}

void TestBand::storeRow(const std::uint64_t* pixels, std::uint8_t* to) const {
  for (std::ptrdiff_t i = 0; i < words_; ++i) storeWord(to + 8 * i, byteOrdered(pixels[i]));
  for (int copy = 1; copy < copies_; ++copy) {
    const int shift = copy * shifts();
    to += copy_bytes_;
    for (std::ptrdiff_t i = 0; i < words_; ++i) {
      storeWord(to + 8 * i, byteOrdered((pixels[i] >> shift) | (pixels[i + 1] << (64 - shift))));
    }
  }
}

void TestBand::load(const BitImage& test_edges, int x, int y) {
  std::uint64_t pixels[kMostWords + 1] = {};
  for (int r = 0; r < side_ + offset_rows_; ++r) {
    const bool exists = y + r < test_edges.height;
    for (int i = 0; i < words_; ++i) {
      pixels[i] = exists ? pixelsAt(test_edges, x + 64 * i, y + r) : 0;
    }
    storeRow(pixels, bytes_.data() + std::ptrdiff_t{stride_} * r);
  }
}

}  // namespace boresight
