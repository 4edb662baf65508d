// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/match/bit_counters.h"
#include "core/match/test_band.h"
#include "core/match/whs_types.h"

namespace boresight {

/// The masked-in edge pixels of a template as byte offsets into a band of test edges, one list for
/// each shift of TestBand. The pixels of a list are counted without shifting bits; only their sum
/// is shifted. Templates with more pixels than the capacity are listed some rows at a time.
class EdgePixels {
 public:
  /// Largest number of shifts of a band.
  static constexpr int kMostShifts = 8;

  void create(int capacity, Arena& arena);  ///< Allocates for `capacity` pixels
  /// Lists the pixels of the rows from `first_row` on that fit; returns the row after them.
  int list(const TemplateView& view, const TestBand& band, int first_row);

  PixelList pixels(int shift) const;  ///< The pixels listed for a shift

 private:
  int countRows(const TemplateView& view, int shifts, int first_row);

  std::span<std::int32_t> offsets_;
  std::array<int, kMostShifts> first_{};
  std::array<int, kMostShifts> count_{};
};

}  // namespace boresight
