// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/refine/edge_refinement.h"

namespace boresight {

/// The two motions of a pose that change the image's edges least along their normals, for as much
/// motion in the image: along a handle, about the axis of a tube. A refinement may have stopped on
/// them at neighbouring edges.
struct WeakDirections {
  /// Offsets (rotation rad, translation m) about the pivot, camera axes; each moves the edge places
  /// by 1 px, root mean square.
  std::array<Vector6d, 2> offset_per_px{Vector6d::Zero(), Vector6d::Zero()};
  /// Share of that motion which is along the edges' normals, root mean square: 0 is undetermined.
  std::array<double, 2> seen{};
  Eigen::Vector3d pivot_in_camera_m = Eigen::Vector3d::Zero();  ///< centre of the scene
  bool known = false;  ///< false when the places determine no directions at all

  /// The pose moved along a direction by that many pixels, root mean square.
  Pose moved(const Pose& camera_from_station, int direction, double motion_px) const {
    return displacedAboutPivot(camera_from_station,
                               motion_px * offset_per_px[static_cast<std::size_t>(direction)],
                               pivot_in_camera_m);
  }
};

/// The weak directions of a refined pose from its samples: generalized eigenvectors of the least
/// eigenvalues of (H, M), H the mean of J_n' J_n over the edges' normals, M the mean of J' J of the
/// places' motion. `camera` is the image's.
WeakDirections weakDirections(const RefinementResult& refined, const Camera& camera,
                              const Eigen::Vector3d& centre_in_station_m);

}  // namespace boresight
