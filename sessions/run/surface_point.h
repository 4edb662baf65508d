// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// What of the scene is seen at a pixel.
struct SurfacePoint {
  Eigen::Vector3d in_station_m = Eigen::Vector3d::Zero();
  double depth_m = 0.0;  ///< z in the camera frame
  std::int32_t face = -1;
};

/// The nearest surface on the ray through a pixel, over all faces (some milliseconds for a hundred
/// thousand); nothing where the ray meets none or the camera has no ray there.
std::optional<SurfacePoint> surfacePointAt(const Camera& camera, const MeshView& mesh,
                                           const Pose& camera_from_station,
                                           const Eigen::Vector2d& pixel);

}  // namespace boresight::sessions
