// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/review/predicted_edges.h"

namespace boresight::sessions {

/// How a pose that is fitted to edges follows an error of the camera: d xi / d (focal length, cx,
/// cy in px) of the least squares over the places' distances along their normals,
/// -(J' J)^-1 J' K. Nothing when the places do not determine the pose.
std::optional<Eigen::Matrix<double, 6, 3>> poseByCamera(std::span<const PredictedPlace> places,
                                                        const Camera& camera,
                                                        const Pose& camera_from_station);

/// Covariance of the pose (left perturbation, camera frame) that comes from the calibration alone:
/// independent errors of the focal length and of the principal point's two coordinates. Zero when
/// both sigmas are; nothing as above.
std::optional<Matrix6d> calibrationCovariance(std::span<const PredictedPlace> places,
                                              const Camera& camera, const Pose& camera_from_station,
                                              double focal_sigma_px, double centre_sigma_px);

}  // namespace boresight::sessions
