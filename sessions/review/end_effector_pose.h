// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose.h"

namespace boresight::sessions {

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
