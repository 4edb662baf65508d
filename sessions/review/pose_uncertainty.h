// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/session/decision.h"
#include "sessions/session/input_sigmas.h"

namespace boresight::sessions {

struct EdgePlace;

/// How a pose that is fitted to edges follows an error of the camera: d xi / d (focal length, cx,
/// cy in px) of the least squares over the places' distances along their normals,
/// -(J' J)^-1 J' K. Nothing when the places do not determine the pose.
std::optional<Eigen::Matrix<double, 6, 3>> poseByCamera(std::span<const EdgePlace> places,
                                                        const Camera& camera,
                                                        const Pose& camera_from_station);

/// The covariance of a case's pose with all of its causes: the one function behind checks,
/// decisions and exports. `picture` is what the run or the annotations say.
/// - A mesh that is larger by s about the middle of its box looks the same from 1 + s times the
///   distance: xi is s times that point in the camera frame, as a translation.
/// - Errors of focal length and principal point are independent; the pose follows them as
///   `poseByCamera` says at the edges that it shows, or where these do not determine it as a shift
///   of the same point that undoes the error.
PoseCovariance poseCovariance(const SessionCase& session_case, const MeshView& mesh,
                              const Pose& camera_from_station, const Matrix6d& picture);

/// Where the end effector is, and what a move commanded from the seed has to be corrected by.
struct EndEffectorPose {
  Pose station_from_end_effector;
  /// Where the end effector is in the frame in which it was thought to be: the identity when the
  /// seed was right. A target planned from the seed as end_effector_seed_from_target is
  /// inverse(this) * end_effector_seed_from_target from where the end effector is.
  Pose end_effector_seed_from_end_effector_estimated;
  /// Of both, over xi = (rotation rad, translation m), right perturbation, in the end effector's
  /// frame: a_from_end_effector * Exp(xi). Zero when the camera's is.
  Matrix6d covariance = Matrix6d::Zero();
};

/// `covariance` is the pose's: left perturbation in the camera frame. The seed and the transform
/// between camera and end effector are taken as exact.
EndEffectorPose endEffectorPose(const Pose& camera_from_station_seed,
                                const Pose& camera_from_station,
                                const Pose& camera_from_end_effector, const Matrix6d& covariance);

}  // namespace boresight::sessions
