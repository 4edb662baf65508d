// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/status.h"
#include "core/match/search_window.h"

namespace boresight {

/// S+ and S- of Pham 2025, Eqs. 1-3: template edge pixels that meet a test edge, and masked-in
/// template non-edge pixels that meet none.
struct WhsCounts {
  std::int32_t edge_hits = 0;   ///< S+
  std::int32_t empty_hits = 0;  ///< S-
  bool operator==(const WhsCounts&) const = default;
};

/// c+ and c-: masked-in edge and non-edge pixels of a template.
struct WhsNorms {
  std::int32_t edges = 0;
  std::int32_t empties = 0;
};

/// The integer in which offsets are compared: S+ * max(c-, 1) + S- * max(c+, 1).
inline std::int64_t whsComparable(const WhsCounts& counts, const WhsNorms& norms) {
  const std::int64_t c_plus = norms.edges > 1 ? norms.edges : 1;
  const std::int64_t c_minus = norms.empties > 1 ? norms.empties : 1;
  return counts.edge_hits * c_minus + counts.empty_hits * c_plus;
}

/// S in [0, 2] for people: S+ / c+ + S- / c-, a term whose count is 0 being 0.
double whsScore(const WhsCounts& counts, const WhsNorms& norms);

/// A square of the render, side `side_px` (even), centred at (center_x, center_y): it spans
/// center - side/2 ... center + side/2 - 1 and lies wholly inside the render. Bits are not copied.
struct TemplateView {
  const BitImage* edges = nullptr;
  const BitImage* mask = nullptr;
  int center_x = 0;
  int center_y = 0;
  int side_px = 0;
};

WhsNorms whsNorms(const TemplateView& view);

/// Counts with the template's centre at (x, y) of the test edges; the whole template must lie
/// inside.
WhsCounts whsCountsAt(const TemplateView& view, const BitImage& test_edges, int x, int y);

/// Result of searching a window.
struct WhsPeak {
  int x = 0, y = 0;  ///< best place of the template's centre
  WhsCounts counts;
  int second_x = 0, second_y = 0;  ///< best place outside the exclusion square around the best
  WhsCounts second_counts;
  bool has_second = false;
};

/// Searches a window for the best offset. Ties go to the smallest squared distance from the
/// predicted place (the template's own centre, or as given), then to raster order. The second best
/// is the best among the 8x8 blocks of offsets (aligned to the window's corner) that do not touch
/// the square of half-side `exclusion_px` around the best. Bit-sliced carry-save counters add the
/// shifted rows of test edges for 64 offsets at once; the mask term comes from run borders. Scratch
/// is taken once.
class WhsSearch {
 public:
  /// `max_side_px` and `max_window_px` (largest extent of a window along an axis) bound every
  /// search.
  Status create(int max_side_px, int max_window_px, Arena& arena);
  /// The window must be clipped so that the whole template lies inside `test_edges`.
  Status begin(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window,
               int predicted_x, int predicted_y, int exclusion_px);
  /// One bounded slice (some rows of offsets); true when `peak()` is complete.
  [[nodiscard]] bool step();
  const WhsPeak& peak() const { return peak_; }
  const WhsNorms& norms() const { return norms_; }

 private:
  WhsPeak peak_;
  WhsNorms norms_;
  // (the implementer of this stage fills this in)
};

/// Sub-pixel place of the peak: one parabola per axis through the comparable scores at the peak and
/// its two neighbours (clamped to +-0.5 px; 0 at the image border or where the parabola is flat).
void subpixelPeak(const TemplateView& view, const BitImage& test_edges, const WhsPeak& peak,
                  double& x, double& y);

/// The score map of a window, row by row, for people who look (not for the flight loop): `map` has
/// window.width() * window.height() entries.
void whsScoreMap(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window,
                 std::span<WhsCounts> map);

}  // namespace boresight
