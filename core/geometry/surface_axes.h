// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/mesh.h"

namespace boresight {

/// Principal axes of the matched parts' surface, as columns, the one of least extent first, and the
/// middle of that surface; station frame.
struct SurfaceAxes {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< of the surface
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit length
};
SurfaceAxes surfaceAxesOf(const MeshView& mesh);

}  // namespace boresight
