// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/nth.h"
#include "core/match/bit_counters.h"
#include "core/match/test_band.h"
#include "core/match/whs_types.h"

namespace boresight {

/// C = corr(M, I): the test edges under the mask, for a row of offsets. From one row of offsets to
/// the next C changes by the test edges under the mask's upper and lower borders,
///   C(x, y + 1) - C(x, y) = sum over (u, v) of [M(u, v - 1) - M(u, v)] I(x + u, y + v),
/// so only borders are counted. Borders of one or two pixels are counted pixel by pixel, longer
/// ones by their ends: from x to x + 1 the sum under a run changes by the pixels that enter and
/// leave. A full mask needs four pixels a row of offsets. The first row, and every row of a mask
/// whose borders are too many to list, is summed up from the ends of all its runs and one exact
/// value.
class MaskCounts {
 public:
  /// Takes the counters for rows of up to `max_words` words of offsets.
  void create(int max_words, const BitKernels& kernels, Arena& arena);
  /// Lists the borders of a template's mask.
  void begin(const TemplateView& view, const TestBand& band);
  /// Counts a row of offsets from scratch; `rows` is the band's row of this row of offsets.
  void computeRow(const TestBand& band, const std::uint8_t* rows, int words);
  /// Updates the counts of the row of offsets at `rows` to those of the row below it.
  void advanceRow(const TestBand& band, const std::uint8_t* rows, int words);

  /// C at offset 64 word + bit of the row.
  std::int32_t count(int word, int bit) const {
    const std::size_t at = static_cast<std::size_t>(lanesBefore(word) + laneIndex(bit));
    return is_small_ ? small_counts_[at] : counts_[at];
  }
  /// Least count of a word's 64 offsets.
  std::int32_t least(int word) const { return nth(least_, word); }
  /// Pixels to be counted for a row of offsets, as a measure of work.
  int work() const;

 private:
  /// A border that is counted by its ends: pixels begin ... end - 1 of row v.
  struct Run {
    std::int16_t v = 0, begin = 0, end = 0, sign = 0;
  };
  void listBorders(int v, const std::uint64_t* above, const std::uint64_t* below);
  void addBorder(int v, int begin, int end, int sign);
  int runSum(const TestBand& band, const std::uint8_t* rows) const;
  void addRunEnds(const std::uint8_t* rows, int words);
  template <class Count>
  void applyChanges(int word, const std::uint16_t* singles, const std::uint16_t* runs,
                    std::uint16_t constant, Count* counts);

  const BitKernels* kernels_ = nullptr;
  TemplateView view_;
  int stride_ = 0, zero_offset_ = 0;
  bool too_many_borders_ = false;
  int border_pixels_ = 0;

  std::span<SignedPixel> singles_;
  int single_count_ = 0, single_negatives_ = 0;
  std::span<SignedPixel> run_ends_;
  int run_end_count_ = 0, run_end_negatives_ = 0;
  std::span<Run> runs_;
  int run_count_ = 0;
  int row_end_count_ = 0;  ///< ends of the runs of all rows of the mask

  std::span<SignedPixel> chunk_;  ///< for computeRow
  int chunk_count_ = 0, chunk_negatives_ = 0;
  CounterRow single_planes_, run_planes_;
  std::span<std::int32_t> differences_;
  std::span<std::uint16_t> under_singles_, under_runs_;
  std::span<std::uint32_t> run_totals_;
  /// In lane order, 64 a word; in 16 bits where the mask's size allows, which is twice as fast.
  std::span<std::int32_t> counts_;
  std::span<std::int16_t> small_counts_;
  bool is_small_ = false;
  std::span<std::int32_t> least_;
  std::array<std::uint16_t, kLanes> slope_of_lane_{};  ///< run_end_negatives_ * x, modulo 2^16
};

}  // namespace boresight
