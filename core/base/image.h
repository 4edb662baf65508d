// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"

namespace boresight {

/// A view of an 8-bit gray image.
struct ImageView {
  const std::uint8_t* data = nullptr;  ///< the top-left pixel; not owned
  int width = 0;                       ///< px
  int height = 0;                      ///< px
  std::ptrdiff_t stride = 0;           ///< bytes from a row to the next one

  /// First pixel of row y.
  const std::uint8_t* row(int y) const { return data + stride * y; }
  /// Gray value of a pixel inside the image.
  std::uint8_t at(int x, int y) const { return row(y)[x]; }
};

/// A view of an image of three interleaved 8-bit channels, in any order.
struct ColorView {
  static constexpr int kChannels = 3;  ///< bytes of a pixel
  const std::uint8_t* data = nullptr;  ///< the top-left pixel; not owned; nullptr: no colour
  int width = 0;                       ///< px
  int height = 0;                      ///< px
  std::ptrdiff_t stride = 0;           ///< bytes from a row to the next one

  /// First pixel of row y.
  const std::uint8_t* row(int y) const { return data + stride * y; }
};

/// A binary image, 64 pixels to a word. Pixel x of row y is bit (x & 63) of word (x >> 6); bits
/// beyond `width` are zero. The unit is the word, so a map's value does not depend on the machine's
/// byte order.
struct BitImage {
  std::span<std::uint64_t> words;  ///< row by row, from the arena
  int width = 0;                   ///< px
  int height = 0;                  ///< px
  int words_per_row = 0;           ///< wordsPerRow(width)

  /// Number of words of a row of `width` pixels.
  static int wordsPerRow(int width) { return (width + 63) / 64; }

  /// A cleared image of `width` x `height` from the arena.
  static BitImage create(Arena& arena, int width, int height) {
    BitImage image;
    image.width = width;
    image.height = height;
    image.words_per_row = wordsPerRow(width);
    image.words = arena.allocate<std::uint64_t>(static_cast<std::size_t>(image.words_per_row) *
                                                static_cast<std::size_t>(height));
    return image;
  }

  /// First word of row y.
  ///@{
  std::uint64_t* row(int y) {
    return words.data() + static_cast<std::ptrdiff_t>(words_per_row) * y;
  }
  const std::uint64_t* row(int y) const {
    return words.data() + static_cast<std::ptrdiff_t>(words_per_row) * y;
  }
  ///@}
  /// Whether a pixel lies inside the image.
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  /// The bit of a pixel inside the image.
  bool get(int x, int y) const { return ((row(y)[x >> 6] >> (x & 63)) & 1u) != 0; }
  /// Sets the bit of a pixel inside the image.
  void set(int x, int y) { row(y)[x >> 6] |= std::uint64_t{1} << (x & 63); }
  /// Clears the bit of a pixel inside the image.
  void reset(int x, int y) { row(y)[x >> 6] &= ~(std::uint64_t{1} << (x & 63)); }
  /// Clears all bits.
  void clear() {
    for (std::uint64_t& word : words) word = 0;
  }
};

}  // namespace boresight
