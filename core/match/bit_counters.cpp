// SPDX-License-Identifier: Apache-2.0
#include "core/match/bit_counters.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/match/bit_rows.h"

namespace boresight {
namespace {

/// N words side by side; with N = 2 compilers keep them in one 128-bit register where there is one.
template <int N>
struct Strip {
  std::uint64_t word[N];
};

template <int N>
struct ByteAligned {
  const std::uint8_t* base;
  const std::int32_t* offsets;

  Strip<N> operator()(int k) const {
    Strip<N> strip;
    std::memcpy(&strip, base + offsets[k], sizeof strip);
    return strip;
  }
  static std::uint64_t finish(std::uint64_t word) { return byteOrdered(word); }
};

template <int N>
struct BitAligned {
  const std::uint8_t* base;
  const SignedPixel* pixels;

  Strip<N> operator()(int k) const {
    const std::uint8_t* bytes = base + (pixels[k] >> 4);
    const unsigned shift = (pixels[k] >> 1) & 7u;
    const std::uint64_t invert = std::uint64_t{0} - (pixels[k] & 1u);
    Strip<N> strip;
    // Two loads a byte apart overlap in 56 bits, so no shift ever reaches 64.
    for (int i = 0; i < N; ++i) {
      strip.word[i] = ((byteOrdered(loadWord(bytes + 8 * i)) >> shift) |
                       (byteOrdered(loadWord(bytes + 8 * i + 1)) << (8 - shift))) ^
                      invert;
    }
    return strip;
  }
  static std::uint64_t finish(std::uint64_t word) { return word; }
};

/// Full adder: sum + a + b = sum' + 2 carry.
template <int N>
inline Strip<N> fullAdd(Strip<N>& sum, const Strip<N>& a, const Strip<N>& b) {
  Strip<N> carry;
  for (int i = 0; i < N; ++i) {
    const std::uint64_t half = sum.word[i] ^ a.word[i];
    carry.word[i] = (sum.word[i] & a.word[i]) | (half & b.word[i]);
    sum.word[i] = half ^ b.word[i];
  }
  return carry;
}

template <int N>
inline Strip<N> halfAdd(Strip<N>& sum, const Strip<N>& a) {
  Strip<N> carry;
  for (int i = 0; i < N; ++i) {
    carry.word[i] = sum.word[i] & a.word[i];
    sum.word[i] ^= a.word[i];
  }
  return carry;
}

template <int N>
struct Counters {
  Strip<N> ones{}, twos{}, fours{}, eights{};
  Strip<N> upper[kMaxPlanes - 4];
  int upper_count;

  explicit Counters(int plane_count) : upper_count(std::max(plane_count - 4, 0)) {
    for (int k = 0; k < upper_count; ++k) upper[k] = {};
  }

  template <class Source>
  Strip<N> addFour(const Source& source, int k) {
    const Strip<N> low = fullAdd(ones, source(k), source(k + 1));
    const Strip<N> high = fullAdd(ones, source(k + 2), source(k + 3));
    return fullAdd(twos, low, high);
  }
  template <class Source>
  Strip<N> addEight(const Source& source, int k) {
    const Strip<N> low = addFour(source, k);
    const Strip<N> high = addFour(source, k + 4);
    return fullAdd(fours, low, high);
  }
  void addSixteens(Strip<N> carry) {
    for (int k = 0; k < upper_count; ++k) carry = halfAdd(upper[k], carry);
  }
};

template <int N, class Source>
inline void storeStrip(const Strip<N>& strip, int plane, int word, CounterRow& result) {
  std::uint64_t* to = result.plane(plane) + word;
  for (int i = 0; i < N; ++i) to[i] = Source::finish(strip.word[i]);
}

template <int N, class Source>
void countStrip(const Source& source, int count, int word, CounterRow& result) {
  Counters<N> counters(result.plane_count);
  int k = 0;
  for (; k + 16 <= count; k += 16) {
    const Strip<N> low = counters.addEight(source, k);
    const Strip<N> high = counters.addEight(source, k + 8);
    counters.addSixteens(fullAdd(counters.eights, low, high));
  }
  if (k + 8 <= count) {
    counters.addSixteens(halfAdd(counters.eights, counters.addEight(source, k)));
    k += 8;
  }
  if (k + 4 <= count) {
    const Strip<N> carry = halfAdd(counters.fours, counters.addFour(source, k));
    counters.addSixteens(halfAdd(counters.eights, carry));
  }
  const Strip<N>* low[] = {&counters.ones, &counters.twos, &counters.fours, &counters.eights};
  for (int plane = 0; plane < std::min(result.plane_count, 4); ++plane) {
    storeStrip<N, Source>(*low[plane], plane, word, result);
  }
  for (int plane = 4; plane < result.plane_count; ++plane) {
    storeStrip<N, Source>(counters.upper[plane - 4], plane, word, result);
  }
}

/// Swaps the bits of b under `mask` with those of a `shift` higher.
inline void swapBits(std::uint64_t& a, std::uint64_t& b, int shift, std::uint64_t mask) {
  const std::uint64_t difference = ((a >> shift) ^ b) & mask;
  b ^= difference;
  a ^= difference << shift;
}

/// Transposes the 8 x 8 bit matrices (word, bit within byte k) for all eight k at once: afterwards
/// bit p of byte k of word w is what was bit 8 k + w of word p.
void transposeBytes(std::uint64_t* word) {
  for (int i = 0; i < 8; i += 2) swapBits(word[i], word[i + 1], 1, 0x5555555555555555u);
  for (int i = 0; i < 8; i += 4) {
    swapBits(word[i], word[i + 2], 2, 0x3333333333333333u);
    swapBits(word[i + 1], word[i + 3], 2, 0x3333333333333333u);
  }
  for (int i = 0; i < 4; ++i) swapBits(word[i], word[i + 4], 4, 0x0f0f0f0f0f0f0f0fu);
}

/// Lanes of counters 8 k + w for even k in lanes[2 w], odd k in lanes[2 w + 1], four to a word.
void planesToLaneWords(const CounterRow& counters, int word, std::uint64_t* lanes) {
  constexpr std::uint64_t kEvenBytes = 0x00ff00ff00ff00ffu;
  std::uint64_t low[8];
  for (int k = 0; k < 8; ++k) low[k] = k < counters.plane_count ? counters.plane(k)[word] : 0;
  transposeBytes(low);
  for (int w = 0; w < 8; ++w) {
    lanes[2 * w] = low[w] & kEvenBytes;
    lanes[2 * w + 1] = (low[w] >> 8) & kEvenBytes;
  }
  if (counters.plane_count <= 8) return;
  for (int k = 0; k < 8; ++k) {
    low[k] = k + 8 < counters.plane_count ? counters.plane(k + 8)[word] : 0;
  }
  transposeBytes(low);
  for (int w = 0; w < 8; ++w) {
    lanes[2 * w] |= (low[w] & kEvenBytes) << 8;
    lanes[2 * w + 1] |= low[w] & ~kEvenBytes;
  }
}

}  // namespace

void countPixels(const std::uint8_t* base, const std::int32_t* offsets, int count, int words,
                 CounterRow& counters) {
  int word = 0;
  for (; word + 2 <= words; word += 2) {
    countStrip<2>(ByteAligned<2>{base + 8 * word, offsets}, count, word, counters);
  }
  if (word < words) {
    countStrip<1>(ByteAligned<1>{base + 8 * word, offsets}, count, word, counters);
  }
}

void countSignedPixels(const std::uint8_t* base, const SignedPixel* pixels, int count, int words,
                       CounterRow& counters) {
  int word = 0;
  for (; word + 2 <= words; word += 2) {
    countStrip<2>(BitAligned<2>{base + 8 * word, pixels}, count, word, counters);
  }
  if (word < words) {
    countStrip<1>(BitAligned<1>{base + 8 * word, pixels}, count, word, counters);
  }
}

void addShifted(const CounterRow& part, int shift, int words, CounterRow& total) {
  for (int i = 0; i < words; ++i) {
    std::uint64_t carry = 0;
    int k = 0;
    for (; k < part.plane_count; ++k) {
      const std::uint64_t* from = part.plane(k) + i;
      const std::uint64_t addend =
          shift == 0 ? from[0] : (from[0] >> shift) | (from[1] << (64 - shift));
      std::uint64_t& sum = total.plane(k)[i];
      const std::uint64_t half = sum ^ addend;
      const std::uint64_t next = (sum & addend) | (half & carry);
      sum = half ^ carry;
      carry = next;
    }
    for (; k < total.plane_count; ++k) {
      std::uint64_t& sum = total.plane(k)[i];
      const std::uint64_t next = sum & carry;
      sum ^= carry;
      carry = next;
    }
  }
}

void planesToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  std::uint64_t lane_words[16];
  planesToLaneWords(counters, word, lane_words);
  std::memcpy(lanes, lane_words, sizeof lane_words);
}

std::uint32_t planesToPrefixSums(const CounterRow& counters, int word, std::uint16_t* lanes) {
  constexpr std::uint64_t kOneEach = 0x0001000100010001u;
  std::uint64_t lane_words[16];
  planesToLaneWords(counters, word, lane_words);
  // Within each run of eight counters (same byte), then over the bytes: a product with 1 in each
  // lane adds up the lanes below.
  std::uint64_t even = 0, odd = 0;
  for (int w = 0; w < 8; ++w) {
    const std::uint64_t even_next = even + lane_words[2 * w];
    const std::uint64_t odd_next = odd + lane_words[2 * w + 1];
    lane_words[2 * w] = even;
    lane_words[2 * w + 1] = odd;
    even = even_next;
    odd = odd_next;
  }
  const std::uint64_t pairs = (even + odd) * kOneEach;
  const std::uint64_t before_even = pairs << 16;
  const std::uint64_t before_odd = before_even + even;
  for (int w = 0; w < 8; ++w) {
    lane_words[2 * w] += before_even;
    lane_words[2 * w + 1] += before_odd;
  }
  std::memcpy(lanes, lane_words, sizeof lane_words);
  return static_cast<std::uint32_t>(pairs >> 48);
}

}  // namespace boresight
