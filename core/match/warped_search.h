// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/match/template_warp.h"
#include "core/match/whs.h"

namespace boresight {

/// What a template is looked for in.
struct SearchTask {
  TemplateView view;                     ///< the template
  const BitImage* test_edges = nullptr;  ///< the level of the edge map
  SearchWindow window;                   ///< where its centre may lie
  WarpGrid warps;                        ///< one alone: as it is
  int exclusion_px = 0;  ///< half side of the square about the best in which there is no second
  bool subpixel = true;  ///< a parabola through the score's peak
};

/// Searches a window for a template in each of its warps and keeps the best, by the score S; of
/// equal ones the first. With one warp alone it is WhsSearch and nothing else. Scratch is taken
/// once; searches share nothing.
class WarpedSearch {
 public:
  /// As WhsSearch::create; with `warps` room for warped bits, too.
  Status create(int max_side_px, int max_window_px, bool warps, Kernels kernels, Arena& arena);
  /// As WhsSearch::begin; what the task points to must outlive the steps.
  Status begin(const SearchTask& task);
  /// One bounded slice; true when all warps have been searched.
  [[nodiscard]] bool step();
  /// Best place and second, of the best warp.
  const WhsPeak& peak() const { return peak_; }
  /// Edge and empty pixels of the template as warped.
  const WhsNorms& norms() const { return norms_; }
  /// The best warp.
  const TemplateWarp& warp() const { return warp_; }
  double x() const { return x_; }  ///< sub-pixel place, when the task asks for it
  /// Sub-pixel place.
  double y() const { return y_; }

 private:
  Status beginWarp();
  void keepIfBest();

  WhsSearch search_;
  WarpedTemplate warped_;
  SearchTask task_;
  TemplateView now_;  ///< being searched for
  std::int32_t index_ = 0;
  double best_score_ = -1.0;
  WhsPeak peak_;
  WhsNorms norms_;
  TemplateWarp warp_;
  double x_ = 0.0, y_ = 0.0;
};

}  // namespace boresight
