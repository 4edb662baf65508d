// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/problem.h"
#include "core/localizer/wide_options.h"
#include "core/localizer/workspace.h"

// Restarts for seeds far off (named by Pham 2025, Sec. V, as future work): where they begin, what
// each of them has to cover, and which of them to go on with.
namespace boresight {

/// Restarts on a grid of turns and depths. Turns tile the range: n of them, 2 range / n apart, or
/// 2 pi / n around the full circle. Depths tile theirs likewise.
class RestartGrid {
 public:
  RestartGrid() = default;
  /// Lays the restarts out about the problem's seed; `scene` is the box of the matched parts.
  RestartGrid(const LocalizationProblem& problem, const BoundingBox& scene,
              const WideOptions& options);

  /// Restarts.
  int count() const { return turns_ * depths_; }
  /// Turns in each depth.
  int turns() const { return turns_; }
  /// Depths with each turn.
  int depths() const { return depths_; }
  /// Of a restart, nearest to the seed first: all turns in the seed's depth, then in the next.
  double turnOf_rad(int restart) const;
  double depthOffsetOf_m(int restart) const;  ///< m along the camera's z axis
  /// The seed turned about the axis, then moved along the camera's z axis.
  Pose poseOf(int restart) const;
  /// How far the truth may be from the restart that is nearest to it, in the restart's camera frame
  /// about `pivot_in_camera_m` of the seed, which goes where the restart takes the scene.
  SeedUncertainty uncertaintyOf(int restart) const;
  /// The same once an iteration has found the pose: half as far in translation.
  SeedUncertainty uncertaintyAfter(const Pose& camera_from_station) const;

 private:
  void layOutTurns(double range_rad, const WideOptions& options);
  SeedUncertainty movedTo(const Pose& camera_from_station, SeedUncertainty uncertainty) const;

  Pose camera_from_station_seed_;
  SeedUncertainty seed_;  ///< as declared
  Eigen::Vector3d middle_in_camera_m_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d axis_in_camera_ = Eigen::Vector3d::UnitZ();
  bool about_view_ = true;
  int turns_ = 1;
  int depths_ = 1;
  double turn_rad_ = 0.0;   ///< between neighbours
  double depth_m_ = 0.0;    ///< between neighbours
  double reach_m_[3] = {};  ///< translation covered, per axis
};

/// How strongly a restart's pose is borne out, in nats beyond chance: by its inliers, against
/// matches spread over their search windows, and by the image's edges where the pose predicts some,
/// against the same render displaced. Each is n D(share | chance), the exponent of the chance that
/// a coin of that chance shows the share in n throws (Chernoff 1952), or 0 below chance. Templates
/// overlap and neighbouring edge pixels go together: their numbers are divided accordingly.
struct Evidence {
  double inliers = 0.0;  ///< of the matches, nats
  double edges = 0.0;    ///< of the edges, nats
  /// Of both, nats.
  double sum() const { return inliers + edges; }
};
Evidence evidenceOf(const Iteration& iteration, const EdgeSupport& support);

/// n D(share | chance) with D the Kullback-Leibler divergence of two coins; 0 unless share exceeds
/// chance.
double excessNats(double count, double share, double chance);

/// The restarts to go on with: solved ones in the order of their evidence, the earlier of equals
/// first, leaving out those within `distinct_px` (displacementBetween_px) of a better one. Writes
/// their indices and returns how many.
int chooseFinalists(std::span<const HypothesisSummary> restarts, const BoundingBox& scene,
                    const Camera& camera, double distinct_px, std::span<std::int32_t> chosen);

}  // namespace boresight
