// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/match/bit_kernels.h"
#include "core/match/column_kernels.h"

/// The loops of ColumnKernels for a Word of several 64-bit integers. Included by one file for each
/// set of kernels, compiled for it: all of it has internal linkage or is inlined always, and calls
/// nothing of the library, since the linker may keep any one of several copies of an inline
/// function and the one with wide registers would fail on lesser machines.
namespace boresight::kernels {
namespace {

template <class Word>
struct LanesOf;
template <>
struct LanesOf<Word2> {
  using Type = std::uint16_t __attribute__((vector_size(16)));
};
template <>
struct LanesOf<Word4> {
  using Type = std::uint16_t __attribute__((vector_size(32)));
};
template <>
struct LanesOf<Word8> {
  using Type = std::uint16_t __attribute__((vector_size(64)));
};
template <class Word>
using Lanes = typename LanesOf<Word>::Type;

template <class Word>
[[gnu::always_inline]] inline Word addLanes(const Word& a, const Word& b) {
  return reinterpret_cast<Word>(reinterpret_cast<Lanes<Word>>(a) +
                                reinterpret_cast<Lanes<Word>>(b));
}
template <class Word>
[[gnu::always_inline]] inline Word subtractLanes(const Word& a, const Word& b) {
  return reinterpret_cast<Word>(reinterpret_cast<Lanes<Word>>(a) -
                                reinterpret_cast<Lanes<Word>>(b));
}

/// Words moved `By` places to higher rows, zeros moving in.
template <int By, class Word, int... Place>
[[gnu::always_inline]] inline Word movedUp(const Word& words,
                                           std::integer_sequence<int, Place...>) {
  // The second operand is zero: its words are numbered from kWordsIn on.
  return __builtin_shufflevector(words, Word{},
                                 (Place >= By ? Place - By : kWordsIn<Word> + Place)...);
}
template <class Word, int... Place>
[[gnu::always_inline]] inline Word lastEverywhere(const Word& words,
                                                  std::integer_sequence<int, Place...>) {
  return __builtin_shufflevector(words, words, (Place * 0 + kWordsIn<Word> - 1)...);
}

/// Sums over the rows up to each row's own.
template <class Word>
[[gnu::always_inline]] inline Word summedRows(Word words) {
  constexpr auto kPlaces = std::make_integer_sequence<int, kWordsIn<Word>>{};
  words = addLanes(words, movedUp<1>(words, kPlaces));
  if constexpr (kWordsIn < Word >> 2) words = addLanes(words, movedUp<2>(words, kPlaces));
  if constexpr (kWordsIn < Word >> 4) words = addLanes(words, movedUp<4>(words, kPlaces));
  return words;
}

template <class Word>
[[gnu::always_inline]] inline bool anyBit(const Word& words) {
  Word1 any = 0;
  for (int i = 0; i < kWordsIn<Word>; ++i) any |= words[i];
  return any != 0;
}
#if defined(BORESIGHT_AVX512_KERNELS)
template <>
[[gnu::always_inline]] inline bool anyBit(const Word8& words) {
  const __m512i all = reinterpret_cast<__m512i>(words);
  return _mm512_test_epi64_mask(all, all) != 0;
}
#endif

/// Words of all ones where the lowest bits of `bits` are.
template <class Word>
[[gnu::always_inline]] inline Word spread(Word1 bits) {
  Word place;
  for (int i = 0; i < kWordsIn<Word>; ++i) place[i] = Word1{1} << i;
  return reinterpret_cast<Word>(((Word{} + bits) & place) != Word{});
}

/// Words shifted to the right, bits of `right` moving in.
template <class Word>
[[gnu::always_inline]] inline Word shiftedRight(const Word& left, const Word& right, int shift) {
  // In two shifts, so that none reaches 64.
  return (left >> shift) | ((right << 1) << (63 - shift));
}
#if defined(BORESIGHT_AVX512_KERNELS)
template <>
[[gnu::always_inline]] inline Word8 shiftedRight(const Word8& left, const Word8& right, int shift) {
  return reinterpret_cast<Word8>(_mm512_shrdv_epi64(
      reinterpret_cast<__m512i>(left), reinterpret_cast<__m512i>(right), _mm512_set1_epi64(shift)));
}
#endif

template <class Word>
void shiftColumn(const std::uint64_t* left, const std::uint64_t* right, int shift, int rows,
                 std::uint64_t* column) {
  constexpr int kStep = kWordsIn<Word>;
  for (int r = 0; r < rows; r += kStep) {
    store(shiftedRight(load<Word>(left + r), load<Word>(right + r), shift), column + r);
  }
}

/// Words of a column from a row on.
template <class Word>
struct ColumnSource {
  const std::uint64_t* columns;
  const std::int32_t* offsets;

  [[gnu::always_inline]] Word operator()(int k) const { return load<Word>(columns + offsets[k]); }
};
template <class Word>
struct ColumnSource<Pair<Word>> {
  const std::uint64_t* columns;
  const std::int32_t* offsets;

  [[gnu::always_inline]] Pair<Word> operator()(int k) const {
    const std::uint64_t* from = columns + offsets[k];
    return {load<Word>(from), load<Word>(from + kWordsIn<Word>)};
  }
};

/// Words of a row of one column after another, under a mask.
template <class Word>
struct MaskedSource {
  const std::uint64_t* words;
  int stride;
  const std::uint64_t* mask;
  int mask_stride, shift;

  [[gnu::always_inline]] Word operator()(int k) const {
    const Word1 bits = mask[std::ptrdiff_t{mask_stride} * k] >> shift;
    return load<Word>(words + std::ptrdiff_t{stride} * k) & spread<Word>(bits);
  }
};

/// total[row] += counters or their complement.
template <class Word>
struct Adder {
  std::uint64_t invert;
  int row;
  CounterRow& total;
  Word carry{};

  [[gnu::always_inline]] void add(int k, const Word& part) {
    Word sum = load<Word>(total.plane(k) + row);
    carry = fullAdd(sum, part ^ invert, carry);
    store(sum, total.plane(k) + row);
  }
  [[gnu::always_inline]] void addCarry(int k) {
    Word sum = load<Word>(total.plane(k) + row);
    carry = halfAdd(sum, carry);
    store(sum, total.plane(k) + row);
  }
};
template <class Word>
struct Adder<Pair<Word>> {
  Adder<Word> upper, lower;

  [[gnu::always_inline]] Adder(std::uint64_t invert, int row, CounterRow& total)
      : upper{invert, row, total}, lower{invert, row + kWordsIn<Word>, total} {}
  [[gnu::always_inline]] void add(int k, const Pair<Word>& part) {
    upper.add(k, part.upper);
    lower.add(k, part.lower);
  }
  [[gnu::always_inline]] void addCarry(int k) {
    upper.addCarry(k);
    lower.addCarry(k);
  }
};

template <class Word>
[[gnu::always_inline]] inline void addCounters(const Counters<Word>& counters, int plane_count,
                                               std::uint64_t invert, int row, CounterRow& total) {
  Adder<Word> adder{invert, row, total};
  counters.forEachPlane(
      plane_count, [&](int k, const Word& part)
                       __attribute__((always_inline)) { adder.add(k, part); });
  for (int k = plane_count; k < total.plane_count; ++k) adder.addCarry(k);
}

/// At one register of rows. Not inlined, so that `columns` is one address in a register.
template <class Word>
[[gnu::noinline]] void addPixelsAt(const std::uint64_t* columns, const std::int32_t* offsets,
                                   int count, int plane_count, std::uint64_t invert, int row,
                                   CounterRow& total) {
  Counters<Word> counters(plane_count);
  counters.addAll(ColumnSource<Word>{columns, offsets}, count);
  addCounters(counters, plane_count, invert, row, total);
}

template <class Word>
void addColumnPixels(const std::uint64_t* columns, const std::int32_t* offsets, int count,
                     int plane_count, int rows, bool negative, CounterRow& total) {
  constexpr int kStep = kWordsIn<Word>;
  const std::uint64_t invert = negative ? ~std::uint64_t{0} : 0;
  int y = 0;
  if constexpr (kStep == 8) {
    for (; y + kStep < rows; y += 2 * kStep) {
      addPixelsAt<Pair<Word>>(columns + y, offsets, count, plane_count, invert, y, total);
    }
  }
  for (; y < rows; y += kStep) {
    addPixelsAt<Word>(columns + y, offsets, count, plane_count, invert, y, total);
  }
}

template <class Word>
void addMasked(const std::uint64_t* words, int stride, const std::uint64_t* mask, int mask_stride,
               int columns, int rows, int plane_count, CounterRow& total) {
  Counters<Word> counters(plane_count);
  for (int v = 0; v < rows; v += kWordsIn<Word>) {
    counters.addAll(MaskedSource<Word>{words + v, stride, mask + (v >> 6), mask_stride, v & 63},
                    columns);
  }
  addCounters(counters, plane_count, 0, 0, total);
}

template <class Word>
void integrate(const CounterRow& changes, int rows, std::uint16_t less, std::uint64_t* first,
               std::uint64_t* counts, std::uint16_t* least) {
  constexpr int kStep = kWordsIn<Word>;
  constexpr auto kPlaces = std::make_integer_sequence<int, kStep>{};
  Word before[kLaneWords];
  for (int w = 0; w < kLaneWords; ++w) before[w] = Word{} + first[w];
  const Word less_everywhere = Word{} + less * std::uint64_t{0x0001000100010001u};
  for (int y = 0; y < rows; y += kStep) {
    Word lanes[kLaneWords];
    planesToLanesAt(changes, y, lanes);
    Lanes<Word> smallest = reinterpret_cast<Lanes<Word>>(~Word{});
    for (int w = 0; w < kLaneWords; ++w) {
      const Word change = subtractLanes(lanes[w], less_everywhere);
      const Word after = addLanes(summedRows(change), before[w]);
      const Word here = subtractLanes(after, change);
      before[w] = lastEverywhere(after, kPlaces);
      store(here, counts + w * kStep);
      const Lanes<Word> here_lanes = reinterpret_cast<Lanes<Word>>(here);
      smallest = here_lanes < smallest ? here_lanes : smallest;
    }
    std::uint16_t smallest_of[4 * kStep];
    store(smallest, smallest_of);
    std::uint16_t smallest_of_all = smallest_of[0];
    for (int i = 1; i < 4 * kStep; ++i) {
      if (smallest_of[i] < smallest_of_all) smallest_of_all = smallest_of[i];
    }
    *least++ = smallest_of_all;
    counts += kLaneWords * kStep;
  }
  for (int w = 0; w < kLaneWords; ++w) first[w] = before[w][0];
}

template <class Word>
bool atLeast(const CounterRow& counters, int row, std::int32_t least, const std::uint64_t* mask,
             std::uint64_t* found) {
  Word result = ~Word{};
  for (int k = 0; k < counters.plane_count; ++k) {
    const Word bits = load<Word>(counters.plane(k) + row);
    result = ((least >> k) & 1) != 0 ? result & bits : result | bits;
  }
  result &= load<Word>(mask);
  if (!anyBit(result)) return false;
  store(result, found);
  return true;
}

template <class Word>
void largest(const CounterRow& counters, int row, const std::uint64_t* mask, std::uint64_t* found) {
  Word result = load<Word>(mask);
  for (int k = counters.plane_count - 1; k >= 0; --k) {
    const Word with_bit = result & load<Word>(counters.plane(k) + row);
    if (anyBit(with_bit)) result = with_bit;
  }
  store(result, found);
}

template <class Word>
inline constexpr ColumnKernels kColumnKernels{
    kWordsIn<Word>,  shiftColumn<Word>, addColumnPixels<Word>, addMasked<Word>,
    integrate<Word>, atLeast<Word>,     largest<Word>};

}  // namespace
}  // namespace boresight::kernels
