// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/end_effector_pose.h"

namespace boresight::sessions {
namespace {

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// a_from_b * Exp(xi_b) = Exp(adjoint * xi_b) * a_from_b with xi = (rotation, translation) and
/// Exp(xi): p -> R p + t, to first order.
Matrix6d adjoint(const Pose& a_from_b) {
  const Eigen::Matrix3d rotation = a_from_b.matrix();
  Matrix6d matrix = Matrix6d::Zero();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.bottomRightCorner<3, 3>() = rotation;
  matrix.bottomLeftCorner<3, 3>() = cross(a_from_b.translation_m) * rotation;
  return matrix;
}

}  // namespace

EndEffectorPose endEffectorPose(const Pose& camera_from_station_seed,
                                const Pose& camera_from_station,
                                const Pose& camera_from_end_effector, const Matrix6d& covariance) {
  EndEffectorPose made;
  made.station_from_end_effector = camera_from_station.inverse() * camera_from_end_effector;
  made.end_effector_seed_from_end_effector_estimated = camera_from_end_effector.inverse() *
                                                       camera_from_station_seed *
                                                       made.station_from_end_effector;
  // camera_from_station -> Exp(xi) camera_from_station turns station_from_end_effector into
  // camera_from_station^-1 Exp(-xi) camera_from_end_effector, which is it times Exp(-Ad xi).
  const Matrix6d turn = adjoint(camera_from_end_effector.inverse());
  made.covariance = turn * covariance * turn.transpose();
  return made;
}

}  // namespace boresight::sessions
