// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "core/base/image.h"

namespace boresight {

/// 64 pixels of a row from column x on: pixel x + k is bit k, pixels right of the image are 0.
/// x >= 0; the row must exist.
inline std::uint64_t pixelsAt(const BitImage& image, int x, int y) {
  const int word = x >> 6;
  const int shift = x & 63;
  if (word >= image.words_per_row) return 0;
  const std::uint64_t* row = image.row(y);
  if (shift == 0) return row[word];
  const std::uint64_t next = word + 1 < image.words_per_row ? row[word + 1] : 0;
  return (row[word] >> shift) | (next << (64 - shift));
}

/// Number of ones. On a target without a popcount instruction, std::popcount is a call and a table.
inline int countOnes(std::uint64_t word) {
  word -= (word >> 1) & 0x5555555555555555u;
  word = (word & 0x3333333333333333u) + ((word >> 2) & 0x3333333333333333u);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<int>((word * 0x0101010101010101u) >> 56);
}

/// The bits of word `word` of a row of `side` pixels.
inline std::uint64_t sideMask(int side, int word) {
  const int rest = side - 64 * word;
  if (rest <= 0) return 0;
  return rest >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rest) - 1;
}

/// A word whose *memory* holds pixels 8 k .. 8 k + 7 in byte k, for any byte order of the machine,
/// from the word that holds pixel k in bit k; its own inverse. Rows stored so can be read at any
/// byte, which shifts them by 8 pixels per byte at no cost.
inline std::uint64_t byteOrdered(std::uint64_t word) {
  if constexpr (std::endian::native == std::endian::little) {
    return word;
  } else {
    std::uint64_t swapped = 0;
    for (int byte = 0; byte < 8; ++byte) {
      swapped |= ((word >> (8 * byte)) & 0xffu) << (56 - 8 * byte);
    }
    return swapped;
  }
}

inline std::uint64_t loadWord(const std::uint8_t* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

inline void storeWord(std::uint8_t* bytes, std::uint64_t word) {
  std::memcpy(bytes, &word, sizeof word);
}

}  // namespace boresight
