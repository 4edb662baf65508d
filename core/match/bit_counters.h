// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

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
  std::uint64_t* words = nullptr;
  int stride = 0;       ///< words from one plane to the next
  int plane_count = 0;  ///< planes in use
  std::uint64_t* plane(int k) { return words + k * stride; }
  const std::uint64_t* plane(int k) const { return words + k * stride; }
};

/// A pixel whose bit is counted: its byte offset, the shift within the byte, and whether 1 - bit is
/// counted instead, in one word: 16 * byte + 2 * shift + negative.
using SignedPixel = std::uint32_t;
inline SignedPixel makeSignedPixel(int byte_offset, int shift, bool negative) {
  return static_cast<SignedPixel>(byte_offset) * 16u + static_cast<SignedPixel>(shift) * 2u +
         (negative ? 1u : 0u);
}

/// counters[x] = sum over k of bit x of the row of pixels that begins at base + offsets[k] (byte
/// ordered, see byteOrdered), for x < 64 * words. `count` is a multiple of 4 (pad with offsets that
/// point to zeros); the planes of `counters` must hold the largest sum. This is the inner loop of
/// the search: full adders take eight rows at a time (Harley and Seal), all else is overhead. A
/// vectorized version has this signature and gives the same planes.
void countPixels(const std::uint8_t* base, const std::int32_t* offsets, int count, int words,
                 CounterRow& counters);

/// The same for pixels at any bit, each positive or negative (1 - bit is added, so that the sum is
/// too large by the number of negative pixels).
void countSignedPixels(const std::uint8_t* base, const SignedPixel* pixels, int count, int words,
                       CounterRow& counters);

/// total[x] += part[x + shift] for x < 64 * words, 0 <= shift < 8; `part` has words + 1 words a
/// plane.
void addShifted(const CounterRow& part, int shift, int words, CounterRow& total);

/// 16-bit lanes: the counters of one word of planes 0 .. 15 as integers. Counter x is
/// lanes[laneIndex(x)]: the order in which the transposition leaves them, so that nothing has to be
/// moved.
inline constexpr int kLanes = 64;
constexpr int laneIndex(int x) {
  const int byte = x >> 3;
  const int lane = byte >> 1;
  const int in_word = std::endian::native == std::endian::little ? lane : 3 - lane;
  return 8 * (x & 7) + 4 * (byte & 1) + in_word;
}
void planesToLanes(const CounterRow& counters, int word, std::uint16_t* lanes);

/// lanes[laneIndex(x)] = sum over x' < x of counter x', for x < 64, and the sum over all 64; as
/// planesToLanes then adding up. Sums must stay below 65536.
std::uint32_t planesToPrefixSums(const CounterRow& counters, int word, std::uint16_t* lanes);

}  // namespace boresight
