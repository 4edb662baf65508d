// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/pose.h"

namespace boresight {

/// A 3D point of the station and its pixel.
struct Correspondence {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();  ///< of the station
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();               ///< px of the full image
  double sigma_px = 1.0;  ///< per axis; in [1e-6, 1e6], or the correspondence is not used
};

/// Gaussian prior on the pose about a hypothesis, in the axes of SeedUncertainty.
struct PosePrior {
  Pose camera_from_station;  ///< mean of the prior
  SeedUncertainty sigma;     ///< the box read as one sigma per axis
};

/// Whether a correspondence can take part: coordinates finite and below 1e9 in magnitude, sigma_px
/// in its range. Others are never inliers and never move a pose.
bool isUsable(const Correspondence& correspondence);

/// Whether a pose is valid as a start: finite, with a quaternion of unit length (to 1e-6).
bool isUsable(const Pose& pose);

/// Whether a prior is valid: its pose is usable, and its sigmas are finite and not negative. Sigmas
/// below 1e-9 (m or rad) count as 1e-9.
bool isUsable(const PosePrior& prior);

}  // namespace boresight
