// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/decision/decision.h"
#include "sessions/session/stated_inputs.h"

namespace boresight::sessions {

struct EdgePlace;

/// Derivative of a pose fitted to edges by an error of the camera: d xi / d (focal length, cx, cy
/// in px) of the least squares over the places' distances along their normals, -(J' J)^-1 J' K.
/// Empty when the places do not determine the pose.
std::optional<Eigen::Matrix<double, 6, 3>> poseByCamera(std::span<const EdgePlace> places,
                                                        const Camera& camera,
                                                        const Pose& camera_from_station);

/// Derivative of the pose by an error of the vectors of a CAHV camera: d xi / d (C, A, H, V ...), 6
/// x 12, 18 or 21. The camera's frame stays fixed in the frame of the vectors, so that an error of
/// C or A moves the pose as well. Empty also outside the CAHV family.
std::optional<Eigen::MatrixXd> poseByVectors(std::span<const EdgePlace> places,
                                             const Camera& camera, const Pose& camera_from_station);

/// The covariance of a case's pose with all of its causes, for checks, decisions and exports.
/// `picture`: covariance from the run or the annotations.
/// - A mesh that is larger by s about the middle of its box looks the same from 1 + s times the
///   distance: xi is s times that point in the camera frame, as a translation.
/// - With a covariance S of the camera's vectors the calibration's term is J S J', with J of
///   `poseByVectors`.
/// - Otherwise errors of focal length and principal point are independent; their effect on the
///   pose is that of `poseByCamera` at the visible edges or, where these do not determine it, a
///   shift of the same point that compensates the error.
PoseCovariance poseCovariance(const SessionCase& session_case, const MeshView& mesh,
                              const Pose& camera_from_station, const Matrix6d& picture);

/// Pose of the end effector, and the correction of a move commanded from the seed.
struct EndEffectorPose {
  Pose station_from_end_effector;
  /// The estimated end-effector frame in that assumed from the seed; the identity when the seed was
  /// correct. A target planned from the seed as end_effector_seed_from_target is inverse(this) *
  /// end_effector_seed_from_target in the estimated frame.
  Pose end_effector_seed_from_end_effector_estimated;
  /// Of both poses, over xi = (rotation rad, translation m), right perturbation, in the end
  /// effector's frame: a_from_end_effector * Exp(xi), with the Exp of `perturbed`. Zero when
  /// `covariance` is zero.
  Matrix6d covariance = Matrix6d::Zero();
};

/// `covariance` is the pose's: left perturbation in the camera frame. The seed is taken as exact.
/// `camera_from_end_effector_covariance`: left perturbation in the camera frame.
EndEffectorPose endEffectorPose(
    const Pose& camera_from_station_seed, const Pose& camera_from_station,
    const Pose& camera_from_end_effector, const Matrix6d& covariance,
    const Matrix6d& camera_from_end_effector_covariance = Matrix6d::Zero());
/// The same of a case that has an end effector, with the covariance that its frames state.
EndEffectorPose endEffectorPose(const SessionCase& session_case, const Pose& camera_from_station,
                                const Matrix6d& covariance);

/// The move of the end effector that compensates the seed's error: after it, a target planned from
/// the seed is reached. At the end effector's origin, along and about the axes of `frame`. The
/// arm's own error in this move is not included.
struct Correction {
  FrameName frame;
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< rotation vector
  /// Over (r rad, t m) in `frame`: the move is rotationExp(r) * rotationExp(rotation_rad) and
  /// translation_m + t. The first is a left perturbation, the second a sum: r does not turn
  /// translation_m.
  Matrix6d covariance = Matrix6d::Zero();
};

/// In the end effector's frame and in every frame that is joined to it; empty for a case without an
/// end effector.
std::vector<Correction> correctionsOf(const SessionCase& session_case,
                                      const Pose& camera_from_station, const Matrix6d& covariance);
/// "correction to command in ARM_BASE: translation ... mm +- ..., rotation ... mrad +- ..."; for
/// the terminal.
std::string correctionText(const Correction& correction);
/// By the frame's text: {"translation_m", "rotation_deg", "covariance"}.
nlohmann::ordered_json toJson(const std::vector<Correction>& corrections);

}  // namespace boresight::sessions
