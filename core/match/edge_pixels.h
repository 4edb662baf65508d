// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/match/test_band.h"
#include "core/match/whs_types.h"

namespace boresight {

/// The masked-in edge pixels of a template as byte offsets into a band of test edges, one list per
/// phase: the pixel's bit within its byte. Pixels of a phase can be counted without shifting bits;
/// only the eight sums are shifted. Templates with more pixels than there is room for are listed
/// some rows at a time.
class EdgePixels {
 public:
  static constexpr int kPhases = 8;

  void create(int capacity, Arena& arena);
  /// Lists the pixels from row `first_row` on, as many rows as fit; returns the row after them.
  int list(const TemplateView& view, const TestBand& band, int first_row);

  int count(int phase) const { return count_[static_cast<std::size_t>(phase)]; }
  /// Offsets of a phase, padded to a multiple of four with pixels that are always zero.
  std::span<const std::int32_t> offsets(int phase) const;

 private:
  std::span<std::int32_t> offsets_;
  std::array<int, kPhases> first_{};
  std::array<int, kPhases> count_{};
};

}  // namespace boresight
