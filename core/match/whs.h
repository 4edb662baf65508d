// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/kernels.h"
#include "core/base/status.h"
#include "core/match/bit_counters.h"
#include "core/match/edge_pixels.h"
#include "core/match/mask_counts.h"
#include "core/match/peak_table.h"
#include "core/match/search_window.h"
#include "core/match/test_band.h"
#include "core/match/whs_types.h"

namespace boresight {

/// Half-side of the square around the best place that is excluded from the second best: within it
/// the same edges still match.
inline constexpr int kSecondPeakExclusion_px = 6;

/// S in [0, 2] for display: S+ / c+ + S- / c-, a term whose count is 0 being 0.
double whsScore(const WhsCounts& counts, const WhsNorms& norms);

WhsNorms whsNorms(const TemplateView& view);

/// Counts with the template's centre at (x, y) of the test edges; the whole template must lie
/// inside.
WhsCounts whsCountsAt(const TemplateView& view, const BitImage& test_edges, int x, int y);

/// Searches a window for the best offset. Ties go to the smallest squared distance from the
/// predicted place (the template's own centre, or as given), then to raster order. The second best
/// is the best among the 8x8 blocks of offsets (aligned to the window's corner) that do not touch
/// the square of half-side `exclusion_px` around the best. Bit-sliced carry-save counters add the
/// shifted rows of test edges for 64 offsets at once (EdgePixels, bit_counters.h). The mask term
/// follows the mask's borders from row to row (MaskCounts). Only offsets above the bound of
/// PeakTable are turned into integers. Scratch is allocated once.
class WhsSearch {
 public:
  /// `max_side_px` and `max_window_px` (largest extent of a window along an axis) bound every
  /// search. kInvalidOption for kernels that are not available. Searches share no data: each worker
  /// may have its own.
  Status create(int max_side_px, int max_window_px, Kernels kernels, Arena& arena);
  /// The window must be clipped so that the whole template lies inside `test_edges`. The images
  /// must outlive the steps. kInvalidOption for a template or window that does not fit its image,
  /// an odd side or a negative exclusion, kCapacityExceeded for sizes above those given to
  /// create(); then step() does nothing.
  Status begin(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window,
               int predicted_x, int predicted_y, int exclusion_px);
  /// One bounded slice (some rows of offsets); true when `peak()` is complete.
  [[nodiscard]] bool step();
  /// Best place and second; complete when step() has returned true.
  const WhsPeak& peak() const { return peak_; }
  /// Edge and empty pixels of the template.
  const WhsNorms& norms() const { return norms_; }

 private:
  std::int64_t stepRow();
  void beginTile();
  void beginRow();
  void countEdges();
  void searchRow();
  void searchWord(int word, std::uint64_t candidates);
  bool nextRow();

  WhsPeak peak_;
  WhsNorms norms_;
  TemplateView view_;
  const BitImage* test_edges_ = nullptr;
  SearchWindow window_;
  bool done_ = true;
  int max_side_px_ = 0, max_window_px_ = 0;

  const BitKernels* bit_kernels_ = nullptr;
  EdgePixels edges_;
  MaskCounts covered_;
  PeakTable peaks_;
  TestBand band_;
  CounterRow hits_;                ///< S+ of a row of offsets
  bool edges_are_listed_ = false;  ///< all at once; else some rows at a time

  // A window is searched in tiles of columns, a tile in bands of rows, so that the band of test
  // edges stays in the cache; the current position of the search:
  int tile_x_ = 0, tile_width_ = 0;  ///< relative to the window
  int row_ = 0;                      ///< row of offsets, relative to the window
};

/// Sub-pixel position of the peak: one parabola per axis through the comparable scores at the peak
/// and its two neighbours (clamped to +-0.5 px; 0 at the image border or where the parabola is
/// flat).
void subpixelPeak(const TemplateView& view, const BitImage& test_edges, const WhsPeak& peak,
                  double& x, double& y);

/// The score map of a window, row by row, for display (not for the flight loop): `map` has
/// window.width() * window.height() entries.
void whsScoreMap(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window,
                 std::span<WhsCounts> map);

}  // namespace boresight
