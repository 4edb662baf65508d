// SPDX-License-Identifier: Apache-2.0
#include "core/match/warped_search.h"

namespace boresight {

Status WarpedSearch::create(int max_side_px, int max_window_px, bool warps, Kernels kernels,
                            Arena& arena) {
  if (warps) warped_.create(max_side_px, arena);
  return search_.create(max_side_px, max_window_px, kernels, arena);
}

Status WarpedSearch::begin(const SearchTask& task) {
  task_ = task;
  index_ = 0;
  best_score_ = -1.0;
  return beginWarp();
}

Status WarpedSearch::beginWarp() {
  now_ = index_ == 0 ? task_.view : warped_.warp(task_.view, task_.warps.at(index_));
  return search_.begin(now_, *task_.test_edges, task_.window, task_.view.center_x,
                       task_.view.center_y, task_.exclusion_px);
}

bool WarpedSearch::step() {
  if (!search_.step()) return false;
  keepIfBest();
  ++index_;
  if (index_ >= task_.warps.count()) return true;
  // The square's size and place are those of the first one, which could be searched for.
  return beginWarp() != Status::kOk;
}

void WarpedSearch::keepIfBest() {
  const double score = whsScore(search_.peak().counts, search_.norms());
  if (score <= best_score_) return;
  best_score_ = score;
  peak_ = search_.peak();
  norms_ = search_.norms();
  warp_ = task_.warps.at(index_);
  x_ = peak_.x;
  y_ = peak_.y;
  if (task_.subpixel) subpixelPeak(now_, *task_.test_edges, peak_, x_, y_);
}

}  // namespace boresight
