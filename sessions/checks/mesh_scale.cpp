// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/mesh_scale.h"

#include <cmath>

#include <Eigen/Dense>

namespace boresight::sessions {
namespace {

constexpr double kLeastBaseline_m = 1e-3;

/// Covariance of a point that is fixed to the station, in the camera frame.
Eigen::Matrix3d pointCovariance(const Matrix6d& covariance,
                                const Eigen::Vector3d& point_in_camera_m) {
  const Eigen::Matrix<double, 3, 6> moves = displacementOf(point_in_camera_m);
  return moves * covariance * moves.transpose();
}

Matrix6d ownCovariance(const PoseCovariance& covariance) {
  return covariance.picture + covariance.calibration;
}

}  // namespace

std::optional<MeshScale> meshScaleByRig(const ReviewSubject& subject,
                                        const Eigen::Vector3d& point_in_station_m) {
  const Pose& pose = subject.camera_from_station;
  const PoseComparer comparer = subject.comparer();
  const Matrix6d own = comparer.determined(ownCovariance(subject.covariance), pose);
  const Eigen::Vector3d here_m = pose * point_in_station_m;
  double information = 0.0;
  double weighted = 0.0;
  for (const OtherPose& other : subject.other_cameras) {
    const Eigen::Vector3d& baseline_m = other.centre_in_camera_m;
    if (baseline_m.norm() < kLeastBaseline_m || !other.covariance.known()) continue;
    const Pose equivalent = comparer.equivalent(other.camera_from_station, pose);
    const Eigen::Vector3d there_m = equivalent * point_in_station_m;
    const Matrix6d others = comparer.determined(ownCovariance(other.covariance), equivalent);
    const Eigen::Matrix3d covariance =
        pointCovariance(own, here_m) + pointCovariance(others, there_m);
    const Eigen::LDLT<Eigen::Matrix3d> factors(covariance);
    if (factors.info() != Eigen::Success || !factors.isPositive()) continue;
    const Eigen::Vector3d weight = factors.solve(baseline_m);
    information += weight.dot(baseline_m);
    weighted += weight.dot(here_m - there_m);
  }
  if (!(information > 0.0) || !std::isfinite(information)) return std::nullopt;
  return MeshScale{weighted / information, 1.0 / std::sqrt(information)};
}

}  // namespace boresight::sessions
