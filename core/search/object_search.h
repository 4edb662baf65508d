// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/edges/direction_distance.h"
#include "core/render/edge_render.h"
#include "core/search/search_candidates.h"
#include "core/search/search_problem.h"
#include "core/search/view_edges.h"

namespace boresight {

/// Which turns, depths and slides are searched. Each range is divided into equal cells; their
/// middles are searched.
struct SearchGrid {
  double tilt_x_rad = 0.0;  ///< about the view's x axis, to either side
  double tilt_y_rad = 0.0;  ///< about the view's y axis, to either side
  double roll_rad = 0.0;    ///< about the view's axis, to either side
  double depth = 0.0;       ///< to either side, as a share of the depth
  int tilts_x = 1;          ///< places
  int tilts_y = 1;          ///< places
  int rolls = 1;            ///< places
  int depths = 1;           ///< places
  int slide_x_px = 0;       ///< to either side, every pixel
  int slide_y_px = 0;       ///< to either side, every pixel
};

/// Searches the pose of the whole object over its seed's uncertainty, at most 60 % of the depth and
/// 56 deg aside: outlines rendered for a grid of tilts are turned, scaled and slid over maps of
/// directed distances
/// (distanceToDirection); the poses whose outlines lie nearest to the image's edges are the
/// candidates. Chamfer matching (Borgefors 1988) with directions (Olson and Huttenlocher 1997).
class ObjectSearch {
 public:
  static constexpr int kMaxSide_px = 256;  ///< of the search's image
  static constexpr int kMaxPoints = 128;   ///< of an outline

  /// Takes the memory of a search from `arena`, apart from the view's and the render's.
  void create(Arena& arena);
  /// Lays out the grid. The problem, `view_edges`, the renderer (for images of kMaxSide_px) and the
  /// render must outlive the steps. False when the scene is not in sight.
  [[nodiscard]] bool begin(const SearchProblem& problem, ViewEdges& view_edges,
                           EdgeRenderer& renderer, EdgeRender& render);
  /// One bounded slice; true when the candidates are complete.
  [[nodiscard]] bool step();

  /// The best poses, the best first.
  std::span<const SearchCandidate> candidates() const { return found_.candidates(); }
  /// Poses compared so far, slides included.
  std::int64_t poses() const { return poses_; }

 private:
  enum class Phase : std::uint8_t { kView = 0, kMaps, kRender, kScore, kDone };
  /// A place of an outline.
  struct Point {
    std::int16_t x = 0, y = 0;  ///< px from the view's middle
    std::int8_t normal_x = 0, normal_y = 0;
  };
  /// A turn about the view's axis and a depth, as they change an outline.
  struct RollDepth {
    double roll_rad = 0.0;
    double depth_ratio = 1.0;
  };

  void layOutGrid(const Eigen::Vector3d& reach_m, const Eigen::Vector3d& reach_rad);
  bool stepRender();
  void makeMap(int direction);
  bool nextTilt();
  RollDepth rollDepthOf(int index) const;
  double tiltX_rad() const;
  double tiltY_rad() const;
  Pose tiltedPose() const;
  void takePoints();
  void sumDistances(const RollDepth& change);
  void addPlace(int direction, int x, int y);
  void takePeaks(const RollDepth& change);
  bool isPeak(int x, int y) const;
  Pose poseOf(const SearchCandidate& candidate) const;
  bool isWithinSeed(const Pose& camera_from_station) const;
  int columns() const { return 2 * grid_.slide_x_px + 1; }
  int rows() const { return 2 * grid_.slide_y_px + 1; }

  const SearchProblem* problem_ = nullptr;
  ViewEdges* view_edges_ = nullptr;
  EdgeRenderer* renderer_ = nullptr;
  EdgeRender* render_ = nullptr;
  double depth_m_ = 0.0;  ///< of the scene's middle
  SearchGrid grid_;
  std::array<std::span<std::uint8_t>, kEdgeDirections> maps_;
  std::array<std::uint8_t, kEdgeDirections> mean_{};  ///< of each map
  std::array<Point, kMaxPoints> points_;
  int point_count_ = 0;
  std::span<std::uint16_t> sums_;  ///< per slide
  CandidateList found_;
  std::int64_t poses_ = 0;
  Phase phase_ = Phase::kDone;
  int next_ = 0;  ///< direction, or roll and depth
  int tilt_ = 0;
  bool rendering_ = false;
};

}  // namespace boresight
