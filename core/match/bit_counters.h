// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/base/kernels.h"

namespace boresight {

/// Bit-sliced counters: plane k holds bit k of 64 counters a word, so that one logical operation
/// works on 64 of them. Counts of up to 512 x 512 pixels need 19 planes.
inline constexpr int kMaxPlanes = 19;

/// Number of planes that hold counts up to `largest`.
inline int planesFor(int largest) {
  int planes = 0;
  for (; largest > 0; largest >>= 1) ++planes;
  return planes;
}

/// Planes of a row of counters: bit k of counter x is bit (x & 63) of plane(k)[x >> 6].
struct CounterRow {
  std::uint64_t* words = nullptr;  ///< plane 0 first
  int stride = 0;                  ///< words from one plane to the next
  int plane_count = 0;             ///< planes in use
  /// First word of plane k.
  std::uint64_t* plane(int k) { return words + std::ptrdiff_t{stride} * k; }
  /// First word of plane k.
  const std::uint64_t* plane(int k) const { return words + std::ptrdiff_t{stride} * k; }
};

/// Rows of counters, and of pixels to be counted, have this many words of slack.
inline constexpr int kWordPadding = 7;

/// Lists of pixels are padded to a multiple of this with pixels that are zero.
inline constexpr int kPixelGroup = 4;
/// The length of a padded list of `count` pixels.
inline constexpr int paddedPixels(int count) {
  return (count + kPixelGroup - 1) / kPixelGroup * kPixelGroup;
}

/// Pixels whose bits are counted: the byte at which each one's row begins, relative to a base.
struct PixelList {
  const std::int32_t* offsets = nullptr;  ///< bytes, one per pixel
  int count = 0;                          ///< paddedPixels() of their number
  int plane_count = 0;                    ///< planes that hold the largest sum
  int shift = 0;                          ///< bit within the byte, the same for all (0 ... 7)
};

/// A pixel at any bit: its byte offset, its bit within the byte, and whether 1 - bit is counted
/// instead, in one word: 16 * byte + 2 * bit + negative.
using SignedPixel = std::uint32_t;
inline SignedPixel makeSignedPixel(int byte_offset, int shift, bool negative) {
  return static_cast<SignedPixel>(byte_offset) * 16u + static_cast<SignedPixel>(shift) * 2u +
         (negative ? 1u : 0u);
}

/// 16-bit lanes: the counters of a word as integers. Counter x of the word is lane laneIndex(x):
/// the order in which the transposition leaves them, so that no data is moved.
inline constexpr int kLanes = 64;
inline constexpr std::ptrdiff_t lanesBefore(int word) { return std::ptrdiff_t{kLanes} * word; }
constexpr int laneIndex(int x) {
  const int byte = x >> 3;
  const int lane = byte >> 1;
  const int in_word = std::endian::native == std::endian::little ? lane : 3 - lane;
  return 8 * (x & 7) + 4 * (byte & 1) + in_word;
}
/// The loops over words of counters, for one set of kernels; every set gives the same counters.
struct BitKernels {
  /// total[x] += sum over k of bit x + shift of the row of pixels that begins at base + offsets[k]
  /// (byte ordered, see byteOrdered), for x < 64 * words - 7, or all x where the shift is 0. Reads
  /// and writes whole registers: up to kWordPadding words more than these, whose content is
  /// unspecified. This is the inner loop of the search: full adders take 64 rows at a time (Harley
  /// and Seal).
  void (*addPixels)(const std::uint8_t* base, const PixelList& pixels, int words,
                    CounterRow& total);
  /// counters[x] = sum over k of pixel k displaced by x, for x < 64 * words (too large by the
  /// number of negative pixels); `count` is a multiple of 4, the planes of `counters` hold the
  /// largest sum.
  void (*countSignedPixels)(const std::uint8_t* base, const SignedPixel* pixels, int count,
                            int words, CounterRow& counters);
  /// The lanes of words 0 ... words - 1 of planes 0 ... 15, kLanes a word.
  void (*planesToLanes)(const CounterRow& counters, int words, std::uint16_t* lanes);
  /// Within each word, lane laneIndex(x) becomes the sum of counters x' < x of this word; `totals`
  /// are the sums over whole words. Sums must stay below 65536.
  void (*planesToPrefixSums)(const CounterRow& counters, int words, std::uint16_t* lanes,
                             std::uint32_t* totals);
};
/// 64-bit words for Kernels::kPortable, 128-bit registers for Kernels::kSse2.
const BitKernels& bitKernels(Kernels set);

/// The lanes of one word of planes 0 ... 15.
void wordToLanes(const CounterRow& counters, int word, std::uint16_t* lanes);

}  // namespace boresight
