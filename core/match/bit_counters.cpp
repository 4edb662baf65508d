// SPDX-License-Identifier: Apache-2.0
#include "core/match/bit_counters.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/match/pixel_words.h"

namespace boresight {
namespace {

// For a Word that is one 64-bit integer or two side by side: only & | ^ + and shifts, which
// compilers offer for both.

using Word1 = std::uint64_t;
#if defined(__GNUC__) && defined(__SSE2__)
using Word2 = std::uint64_t __attribute__((vector_size(16)));
#endif

template <class Word>
constexpr int kWordsIn = static_cast<int>(sizeof(Word) / sizeof(Word1));

[[gnu::always_inline]] inline std::ptrdiff_t bytesBefore(int word) {
  return std::ptrdiff_t{8} * word;
}

template <class Word>
[[gnu::always_inline]] inline Word load(const void* from) {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

template <class Word>
[[gnu::always_inline]] inline void store(const Word& word, void* to) {
  std::memcpy(to, &word, sizeof word);
}

template <class Word, int... Place>
[[gnu::always_inline]] inline Word shiftedIn(const Word& words, Word1 right,
                                             std::integer_sequence<int, Place...>) {
  const Word last{right};
  return __builtin_shufflevector(words, last, (Place + 1)...);
}

/// The words one place to the right, of which the last is `right`.
template <class Word>
[[gnu::always_inline]] inline Word nextWords(const Word& words, Word1 right) {
  if constexpr (kWordsIn<Word> == 1) {
    return right;
  } else {
    return shiftedIn(words, right, std::make_integer_sequence<int, kWordsIn<Word>>{});
  }
}

template <class Word>
[[gnu::always_inline]] inline Word1 firstOf(const Word& words) {
  if constexpr (kWordsIn<Word> == 1) {
    return words;
  } else {
    return words[0];
  }
}

/// Pixels in bit order from byte-ordered memory; registers of several words are used on
/// little-endian machines only.
template <class Word>
[[gnu::always_inline]] inline Word inOrder(const Word& words) {
  if constexpr (kWordsIn<Word> == 1) {
    return byteOrdered(words);
  } else {
    static_assert(kWordsIn<Word> > 1 && std::endian::native == std::endian::little);
    return words;
  }
}

/// Full adder: sum + a + b = sum' + 2 carry.
template <class Word>
[[gnu::always_inline]] inline Word fullAdd(Word& sum, const Word& a, const Word& b) {
  const Word half = sum ^ a;
  const Word carry = (sum & a) | (half & b);
  sum = half ^ b;
  return carry;
}

template <class Word>
[[gnu::always_inline]] inline Word halfAdd(Word& sum, const Word& a) {
  const Word carry = sum & a;
  sum ^= a;
  return carry;
}

/// A row of pixels that begins at a byte.
template <class Word>
struct ByteAligned {
  const std::uint8_t* base;
  const std::int32_t* offsets;

  [[gnu::always_inline]] Word operator()(int k) const { return load<Word>(base + offsets[k]); }
};

/// A row of pixels that begins at a bit, as it is or inverted.
template <class Word>
struct BitAligned {
  const std::uint8_t* base;
  const SignedPixel* pixels;

  [[gnu::always_inline]] Word operator()(int k) const {
    const SignedPixel pixel = pixels[k];
    const std::uint8_t* bytes = base + (pixel >> 4);
    const int shift = static_cast<int>(pixel >> 1) & 7;
    const std::uint64_t invert = std::uint64_t{0} - (pixel & 1u);
    // Two loads a byte apart overlap in 56 bits, so no shift ever reaches 64.
    return ((inOrder(load<Word>(bytes)) >> shift) |
            (inOrder(load<Word>(bytes + 1)) << (8 - shift))) ^
           invert;
  }
};

/// Bit-sliced counters of one register. The low planes stay in registers: carries from 64 rows at a
/// time go to the upper ones.
template <class Word>
struct Counters {
  static constexpr int kLow = 6;
  Word low[kLow] = {};
  Word upper[kMaxPlanes - kLow];
  int upper_count;

  [[gnu::always_inline]] explicit Counters(int plane_count)
      : upper_count(plane_count > kLow ? plane_count - kLow : 0) {
    for (int k = 0; k < upper_count; ++k) upper[k] = Word{};
  }

  /// Adds 2^(Level + 1) rows; returns the carry out of plane `Level`.
  template <int Level, class Source>
  [[gnu::always_inline]] Word addRows(const Source& source, int k) {
    if constexpr (Level == 0) {
      return fullAdd(low[0], source(k), source(k + 1));
    } else {
      const Word first = addRows<Level - 1>(source, k);
      const Word second = addRows<Level - 1>(source, k + (1 << Level));
      return fullAdd(low[Level], first, second);
    }
  }
  /// Adds a carry into plane `Level` and all above.
  template <int Level>
  [[gnu::always_inline]] void addCarry(Word carry) {
    if constexpr (Level < kLow) {
      addCarry<Level + 1>(halfAdd(low[Level], carry));
    } else {
      for (int k = 0; k < upper_count; ++k) carry = halfAdd(upper[k], carry);
    }
  }
  /// Adds `count` rows, a multiple of four.
  template <class Source>
  [[gnu::always_inline]] void addAll(const Source& source, int count) {
    int k = 0;
    for (; k + 64 <= count; k += 64) addCarry<6>(addRows<5>(source, k));
    if (k + 32 <= count) {
      addCarry<5>(addRows<4>(source, k));
      k += 32;
    }
    if (k + 16 <= count) {
      addCarry<4>(addRows<3>(source, k));
      k += 16;
    }
    if (k + 8 <= count) {
      addCarry<3>(addRows<2>(source, k));
      k += 8;
    }
    if (k + 4 <= count) addCarry<2>(addRows<1>(source, k));
  }
  /// Calls f(k, plane k) for the planes in use.
  template <class Function>
  [[gnu::always_inline]] void forEachPlane(int plane_count, const Function& f) const {
    if (plane_count > 0) f(0, low[0]);
    if (plane_count > 1) f(1, low[1]);
    if (plane_count > 2) f(2, low[2]);
    if (plane_count > 3) f(3, low[3]);
    if (plane_count > 4) f(4, low[4]);
    if (plane_count > 5) f(5, low[5]);
    for (int k = kLow; k < plane_count; ++k) f(k, upper[k - kLow]);
  }
};

/// addPixels() for the words at `word`. `right` holds, per plane, the word to the right of them,
/// and afterwards the first of them.
template <class Word>
[[gnu::always_inline]] inline void addPixelsAt(const std::uint8_t* base, const PixelList& pixels,
                                               int word, Word1* right, CounterRow& total) {
  Counters<Word> counters(pixels.plane_count);
  counters.addAll(ByteAligned<Word>{base + bytesBefore(word), pixels.offsets}, pixels.count);
  const int shift = pixels.shift;
  Word carry{};
  const auto add = [&](int k, const Word& part) __attribute__((always_inline)) {
    const Word counts = inOrder(part);
    const Word addend = (counts >> shift) | ((nextWords(counts, right[k]) << 1) << (63 - shift));
    right[k] = firstOf(counts);
    Word sum = load<Word>(total.plane(k) + word);
    carry = fullAdd(sum, addend, carry);
    store(sum, total.plane(k) + word);
  };
  counters.forEachPlane(pixels.plane_count, add);
  for (int k = pixels.plane_count; k < total.plane_count; ++k) {
    Word sum = load<Word>(total.plane(k) + word);
    carry = halfAdd(sum, carry);
    store(sum, total.plane(k) + word);
  }
}

template <class Word>
[[gnu::always_inline]] inline void countSignedPixelsAt(const std::uint8_t* base,
                                                       const SignedPixel* pixels, int count,
                                                       int word, CounterRow& result) {
  Counters<Word> counters(result.plane_count);
  counters.addAll(BitAligned<Word>{base + bytesBefore(word), pixels}, count);
  counters.forEachPlane(
      result.plane_count, [&](int k, const Word& part) __attribute__((always_inline)) {
        store(part, result.plane(k) + word);
      });
}

/// Swaps the bits of b under `mask` with those of a `shift` higher.
template <class Word>
[[gnu::always_inline]] inline void swapBits(Word& a, Word& b, int shift, std::uint64_t mask) {
  const Word difference = ((a >> shift) ^ b) & mask;
  b ^= difference;
  a ^= difference << shift;
}

/// Transposes the 8 x 8 bit matrices (row, bit within byte k) for all eight k at once: afterwards
/// bit p of byte k of row w is what was bit 8 k + w of row p.
template <class Word>
[[gnu::always_inline]] inline void transposeBytes(Word* row) {
  for (int i = 0; i < 8; i += 2) swapBits(row[i], row[i + 1], 1, 0x5555555555555555u);
  for (int i = 0; i < 8; i += 4) {
    swapBits(row[i], row[i + 2], 2, 0x3333333333333333u);
    swapBits(row[i + 1], row[i + 3], 2, 0x3333333333333333u);
  }
  for (int i = 0; i < 4; ++i) swapBits(row[i], row[i + 4], 4, 0x0f0f0f0f0f0f0f0fu);
}

/// The same where rows 4 ... 7 are zero.
template <class Word>
[[gnu::always_inline]] inline void transposeNibbles(Word* row) {
  for (int i = 0; i < 4; i += 2) swapBits(row[i], row[i + 1], 1, 0x5555555555555555u);
  swapBits(row[0], row[2], 2, 0x3333333333333333u);
  swapBits(row[1], row[3], 2, 0x3333333333333333u);
  for (int w = 0; w < 4; ++w) {
    row[w + 4] = (row[w] >> 4) & 0x0f0f0f0f0f0f0f0fu;
    row[w] &= 0x0f0f0f0f0f0f0f0fu;
  }
}

constexpr int kLaneWords = 16;  ///< words that hold the lanes of a word of counters

/// Lanes of counters 8 k + w for even k in lanes[2 w], odd k in lanes[2 w + 1], four to a word.
template <class Word>
[[gnu::always_inline]] inline void planesToLanesAt(const CounterRow& counters, int word,
                                                   Word* lanes) {
  constexpr std::uint64_t kEvenBytes = 0x00ff00ff00ff00ffu;
  Word rows[8];
  const auto loadFrom = [&](int first) __attribute__((always_inline)) {
    for (int k = 0; k < 8; ++k) {
      const bool exists = first + k < counters.plane_count;
      rows[k] = exists ? load<Word>(counters.plane(first + k) + word) : Word{};
    }
  };
  loadFrom(0);
  if (counters.plane_count <= 4) {
    transposeNibbles(rows);
  } else {
    transposeBytes(rows);
  }
  for (std::ptrdiff_t w = 0; w < 8; ++w) {
    lanes[2 * w] = rows[w] & kEvenBytes;
    lanes[2 * w + 1] = (rows[w] >> 8) & kEvenBytes;
  }
  if (counters.plane_count <= 8) return;
  loadFrom(8);
  transposeBytes(rows);
  for (std::ptrdiff_t w = 0; w < 8; ++w) {
    lanes[2 * w] |= (rows[w] & kEvenBytes) << 8;
    lanes[2 * w + 1] |= rows[w] & ~kEvenBytes;
  }
}

/// Replaces lanes by the sums of the lanes of counters to their left.
template <class Word>
[[gnu::always_inline]] inline void addUpLanes(Word* lanes, std::uint32_t* totals) {
  // Within each run of eight counters (same byte), then over the bytes.
  Word even{}, odd{};
  for (int w = 0; w < kLaneWords; w += 2) {
    const Word even_before = even, odd_before = odd;
    even += lanes[w];
    odd += lanes[w + 1];
    lanes[w] = even_before;
    lanes[w + 1] = odd_before;
  }
  Word pairs = even + odd;  // every lane plus those below it: a product with 1 in each lane
  pairs += pairs << 16;
  pairs += pairs << 32;
  const Word before_even = pairs << 16;
  const Word before_odd = before_even + even;
  for (int w = 0; w < kLaneWords; w += 2) {
    lanes[w] += before_even;
    lanes[w + 1] += before_odd;
  }
  std::uint64_t sums[kWordsIn<Word>];
  store(pairs, sums);
  for (int i = 0; i < kWordsIn<Word>; ++i) totals[i] = static_cast<std::uint32_t>(sums[i] >> 48);
}

template <class Word>
[[gnu::always_inline]] inline void storeLanes(const Word* lane_words, std::uint16_t* lanes) {
  std::uint64_t words[kLaneWords][kWordsIn<Word>];
  for (int w = 0; w < kLaneWords; ++w) store(lane_words[w], words[w]);
  for (int i = 0; i < kWordsIn<Word>; ++i) {
    for (int w = 0; w < kLaneWords; ++w) {
      std::memcpy(lanes + lanesBefore(i) + std::ptrdiff_t{4} * w, &words[w][i], sizeof words[w][i]);
    }
  }
}

template <class Word>
void wordsToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  Word lane_words[kLaneWords];
  planesToLanesAt(counters, word, lane_words);
  storeLanes(lane_words, lanes);
}

template <class Word>
void wordsToPrefixSums(const CounterRow& counters, int word, std::uint16_t* lanes,
                       std::uint32_t* totals) {
  Word lane_words[kLaneWords];
  planesToLanesAt(counters, word, lane_words);
  addUpLanes(lane_words, totals);
  storeLanes(lane_words, lanes);
}

template <class Word>
void addPixels(const std::uint8_t* base, const PixelList& pixels, int words, CounterRow& total) {
  // From right to left, as each word takes bits from the one to its right.
  Word1 right[kMaxPlanes] = {};
  int word = (words + kWordsIn<Word> - 1) / kWordsIn<Word> * kWordsIn<Word>;
  while (word > 0) {
    addPixelsAt<Word>(base, pixels, word -= kWordsIn<Word>, right, total);
  }
}

template <class Word>
void countSignedPixels(const std::uint8_t* base, const SignedPixel* pixels, int count, int words,
                       CounterRow& counters) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    countSignedPixelsAt<Word>(base, pixels, count, word, counters);
  }
  for (; word < words; ++word) {
    countSignedPixelsAt<Word1>(base, pixels, count, word, counters);
  }
}

template <class Word>
void planesToLanes(const CounterRow& counters, int words, std::uint16_t* lanes) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    wordsToLanes<Word>(counters, word, lanes + lanesBefore(word));
  }
  for (; word < words; ++word) wordsToLanes<Word1>(counters, word, lanes + lanesBefore(word));
}

template <class Word>
void planesToPrefixSums(const CounterRow& counters, int words, std::uint16_t* lanes,
                        std::uint32_t* totals) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    wordsToPrefixSums<Word>(counters, word, lanes + lanesBefore(word), totals + word);
  }
  for (; word < words; ++word) {
    wordsToPrefixSums<Word1>(counters, word, lanes + lanesBefore(word), totals + word);
  }
}

template <class Word>
constexpr BitKernels kBitKernels{addPixels<Word>, countSignedPixels<Word>, planesToLanes<Word>,
                                 planesToPrefixSums<Word>};

}  // namespace

const BitKernels& bitKernels(Kernels set) {
#if defined(__GNUC__) && defined(__SSE2__)
  if (set != Kernels::kPortable) return kBitKernels<Word2>;
#else
  (void)set;
#endif
  return kBitKernels<Word1>;
}

void wordToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  wordsToLanes<Word1>(counters, word, lanes);
}

}  // namespace boresight
