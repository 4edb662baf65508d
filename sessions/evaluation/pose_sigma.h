// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// One sigma of a pose in the terms that requirements judge (compare PoseError).
struct PoseSigma {
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();  ///< along the camera's axes
  Eigen::Vector3d rotation_mrad = Eigen::Vector3d::Zero();   ///< about the camera's axes
  double normal_mm = 0.0;                                    ///< along the camera's axis
  double lateral_mm = 0.0;         ///< across it: root of the sum of both variances
  double out_of_plane_mrad = 0.0;  ///< between the axes: the same of the turns about x and y
};

/// Where translations are judged: "end effector", or "camera" where that is not known.
const char* judgedPlace(const std::optional<Pose>& camera_from_end_effector);

/// From a covariance over xi = (rotation rad, translation m) of the left perturbation in the camera
/// frame. Translations are those of the end effector's origin p in the camera frame (the camera's
/// centre without one): d = r x p + t. Nothing when the covariance is zero, not finite, or has a
/// negative variance.
std::optional<PoseSigma> poseSigma(const Matrix6d& covariance,
                                   const std::optional<Pose>& camera_from_end_effector);

/// One sigma of where points are seen: root of the mean over the points of the variance of both
/// coordinates together, px. Nothing when none of them projects.
std::optional<double> projectionSigma(const Camera& camera, const Pose& camera_from_station,
                                      std::span<const Eigen::Vector3f> points_in_station_m,
                                      const Matrix6d& covariance);

}  // namespace boresight::sessions
