// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/kernels.h"
#include "core/match/bit_counters.h"

namespace boresight {

/// Inner loops of a search (ColumnSearch) that looks at 64 columns of offsets at a time and puts
/// several *rows* of offsets side by side into a wide register: narrow windows, which most are,
/// fill it as well as wide ones. A shifted column is an array of words, one a row of test edges:
/// bit x of word r is the test edge at column x + u, row r. Rows are counted in whole registers: up
/// to kMostRows - 1 more than asked for are read and written, of which nothing is to be expected.
/// Every set of kernels gives the same numbers.
struct ColumnKernels {
  static constexpr int kMostRows = 8;    ///< most rows in a register
  static constexpr int kLaneWords = 16;  ///< words that hold 64 counters of 16 bits

  int rows = 0;  ///< of offsets in a register

  /// column[r] = 64 pixels from bit `shift` (0 ... 63) of left[r], which right[r] continues.
  void (*shiftColumn)(const std::uint64_t* left, const std::uint64_t* right, int shift, int rows,
                      std::uint64_t* column);

  /// total[y][x] += sum over k of bit x of columns[offsets[k] + y] for y < rows; or, when negative,
  /// 2^plane_count - 1 minus that sum. Word y of a plane of `total` holds the counters of row y.
  /// `count` is a multiple of 4; `plane_count` planes hold the sum.
  void (*addPixels)(const std::uint64_t* columns, const std::int32_t* offsets, int count,
                    int plane_count, int rows, bool negative, CounterRow& total);

  /// total[r][x] += bits x of the words of `columns` columns, `stride` words apart, under a mask:
  /// bit v & 63 of mask[mask_stride * column + (v >> 6)] for word v, v < rows. In r = v % rows of a
  /// register. `columns` is a multiple of 4.
  void (*addMasked)(const std::uint64_t* words, int stride, const std::uint64_t* mask,
                    int mask_stride, int columns, int rows, int plane_count, CounterRow& total);

  /// Counters as integers: counts[y][x] = first[x] + sum over y' < y of (changes[y'][x] - less),
  /// modulo 2^16, and first[x] becomes that of the row after the last. `first` has four lanes a
  /// word, in the order of laneIndex. counts: see countAt; least: of each register's rows.
  void (*integrate)(const CounterRow& changes, int rows, std::uint16_t less, std::uint64_t* first,
                    std::uint64_t* counts, std::uint16_t* least);

  /// Bit x of found[y] is 1 where counter (x, y) of one register's rows is at least `least`; false
  /// when there is none under `mask` (a word a row).
  bool (*atLeast)(const CounterRow& counters, int row, std::int32_t least,
                  const std::uint64_t* mask, std::uint64_t* found);
  /// The same for the largest of these counters.
  void (*largest)(const CounterRow& counters, int row, const std::uint64_t* mask,
                  std::uint64_t* found);
};

/// Null for what this build does not have, and for Kernels::kPortable and kSse2: with fewer rows in
/// a register, shifting the columns costs more than it saves.
const ColumnKernels* columnKernels(Kernels kernels);

/// Word of `counts` (see integrate) that holds the lane of counter (x, y), and the lane's bit.
inline int countWord(const ColumnKernels& kernels, int x, int y) {
  return (y / kernels.rows * ColumnKernels::kLaneWords + laneIndex(x) / 4) * kernels.rows +
         y % kernels.rows;
}

}  // namespace boresight
