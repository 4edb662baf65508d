// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/fixed_list.h"
#include "core/render/edge_render.h"
#include "core/search/compass_search.h"
#include "core/search/rotation_grid.h"
#include "core/search/search_candidates.h"
#include "core/search/search_problem.h"
#include "core/search/slide_sums.h"
#include "core/search/view_edges.h"

namespace boresight {

/// Searches the pose of the whole object over its seed's uncertainty, at most 60 % of the depth and
/// 56 deg off the axis. Outlines rendered for the view directions of a RotationGrid are turned,
/// scaled and slid over maps of directed distances (SlideSums). The candidates are the poses whose
/// outlines lie nearest to the image's edges. Chamfer matching (Borgefors 1988) with directions
/// (Olson and Huttenlocher 1997). The object is small in the search's image, and the grid is
/// coarse: a compass search starts from each candidate.
class ObjectSearch {
 public:
  static constexpr double kSpan_px = 48.0;  ///< of the object in the search's image

  /// Takes the memory of a search from `arena`, apart from the view's and the render's.
  void create(Arena& arena) { sums_.create(arena); }
  /// Lays out the grid. The problem, `view_edges`, the renderer (for images of
  /// SlideSums::kMaxView_px) and the render must outlive the steps. False when the scene is outside
  /// the image.
  [[nodiscard]] bool begin(const SearchProblem& problem, ViewEdges& view_edges,
                           EdgeRenderer& renderer, EdgeRender& render);
  /// One bounded slice; true when the candidates are complete.
  [[nodiscard]] bool step();
  /// Restarts the search's view of the scene; false when it is outside the image.
  [[nodiscard]] bool beginView() {
    return view_edges_->begin(*problem_, problem_->camera_from_station_seed, view_size_);
  }

  /// The best poses, the best first.
  std::span<const SearchCandidate> candidates() const { return found_.candidates(); }
  /// Poses compared so far, slides included.
  std::int64_t poses() const { return poses_; }

 private:
  enum class Phase : std::uint8_t { kView = 0, kMaps, kRender, kScore, kDescend, kDone };
  /// A place of an outline.
  struct Point {
    double x_px = 0.0, y_px = 0.0;  ///< from the view's middle
    double normal_x = 0.0, normal_y = 0.0;
  };

  bool layOut();
  bool stepRender();
  bool nextDirection();
  bool nextDescent();
  void descend();
  double depthRatio(int depth) const;
  Pose renderedPose() const;
  void takePoints();
  void scoreTurn(int turn);
  void takePeaks(int turn, double depth_ratio);
  Pose poseOf(const SearchCandidate& candidate) const;
  bool isWithinSeed(const Pose& camera_from_station) const;

  const SearchProblem* problem_ = nullptr;
  ViewEdges* view_edges_ = nullptr;
  EdgeRenderer* renderer_ = nullptr;
  EdgeRender* render_ = nullptr;
  ViewSize view_size_;
  double depth_m_ = 0.0;  ///< of the scene's middle
  RotationGrid rotations_;
  double depth_range_ = 0.0;  ///< to either side, as a share of the depth
  int depths_ = 1;            ///< middles of equal cells of that range
  int slide_x_px_ = 0;        ///< to either side, every pixel
  int slide_y_px_ = 0;        ///< to either side, every pixel
  SlideSums sums_;
  FixedList<Point, SlideSums::kMaxPlaces> points_;
  CompassSearch compass_;
  CandidateList grid_found_;  ///< on the grid
  CandidateList found_;       ///< after their descent
  std::int64_t poses_ = 0;
  Phase phase_ = Phase::kDone;
  int next_ = 0;  ///< direction of edges, turn, or candidate on the grid
  bool descends_ = false;
  bool rendering_ = false;
};

}  // namespace boresight
