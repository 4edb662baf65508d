// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/nth.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/refine/edge_refinement.h"

namespace boresight {

/// The two motions of a pose that move the edges least along their normals, for the same motion in
/// the image: along a handle, about the axis of a tube. Along them a refinement may have stopped at
/// neighbouring edges.
struct WeakDirections {
  /// Offsets (rotation rad, translation m) about the pivot, camera axes; each moves the edge places
  /// by 1 px, root mean square.
  std::array<Vector6d, 2> offset_per_px{Vector6d::Zero(), Vector6d::Zero()};
  /// Share of that motion along the edges' normals, root mean square.
  std::array<double, 2> seen{};
  Eigen::Vector3d pivot_in_camera_m = Eigen::Vector3d::Zero();  ///< centre of the scene
  bool known = false;  ///< false when the samples determine no directions at all

  /// A smaller share leaves a direction undetermined. The facets of a coarse tube show up to 0.1 of
  /// a turn about its axis, and agree with each other in a wrong turn.
  static constexpr double kUndetermined = 0.12;
  /// Whether the edges leave the direction undetermined.
  bool isUndetermined(std::size_t direction) const {
    return known && seen[direction] < kUndetermined;
  }

  /// The pose moved along a direction by `motion_px`, root mean square over the edge places.
  Pose moved(const Pose& camera_from_station, int direction, double motion_px) const {
    return displacedAboutPivot(camera_from_station, motion_px * nth(offset_per_px, direction),
                               pivot_in_camera_m);
  }
};

/// How edge places move in their images with a pose, summed over the places of one or several
/// views. Offsets are about the pivot, in the axes of the first view's camera.
class EdgeMotion {
 public:
  /// Offsets about a point of the first view's camera frame.
  explicit EdgeMotion(const Eigen::Vector3d& pivot_in_camera_m)
      : pivot_in_camera_m_(pivot_in_camera_m) {}

  /// Adds the samples of a refined pose. `camera` is the image's.
  void add(const RefinementResult& refined, const Camera& camera,
           const Pose& camera_from_first = Pose());
  /// Generalized eigenvectors of the least eigenvalues of (H, M), H the mean of J_n' J_n over the
  /// edges' normals, M the mean of J' J of the places' motion.
  WeakDirections weakDirections() const;

 private:
  Eigen::Vector3d pivot_in_camera_m_;
  Matrix6d along_normals_ = Matrix6d::Zero();  ///< lower triangle
  Matrix6d in_image_ = Matrix6d::Zero();       ///< lower triangle
  std::int32_t places_ = 0;
};

/// The weak directions of a pose that one view refined. `camera` is the image's.
WeakDirections weakDirections(const RefinementResult& refined, const Camera& camera,
                              const Eigen::Vector3d& centre_in_station_m);

/// The covariance of a refined pose (camera axes, about the camera's centre), with the variance
/// that the seed's uncertainty leaves added along undetermined directions.
Matrix6d withUndetermined(const Matrix6d& covariance, const WeakDirections& weak,
                          const SeedUncertainty& uncertainty);

}  // namespace boresight
