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
  Eigen::Matrix<double, 3, 6> moves;
  for (int i = 0; i < 3; ++i)
    moves.col(i) = Eigen::Vector3d(Eigen::Vector3d::Unit(i)).cross(point_in_camera_m);
  moves.rightCols<3>().setIdentity();
  return moves * covariance * moves.transpose();
}

Matrix6d ownCovariance(const PoseCovariance& covariance) {
  return covariance.picture + covariance.calibration;
}

}  // namespace

std::optional<MeshScale> meshScaleByRig(const ReviewSubject& subject,
                                        const Eigen::Vector3d& point_in_station_m) {
  const Eigen::Vector3d here_m = subject.camera_from_station * point_in_station_m;
  double information = 0.0;
  double weighted = 0.0;
  for (const OtherPose& other : subject.other_cameras) {
    const Eigen::Vector3d& baseline_m = other.centre_in_camera_m;
    if (baseline_m.norm() < kLeastBaseline_m || !other.covariance.known()) continue;
    const Eigen::Vector3d there_m = other.camera_from_station * point_in_station_m;
    const Eigen::Matrix3d covariance = pointCovariance(ownCovariance(subject.covariance), here_m) +
                                       pointCovariance(ownCovariance(other.covariance), there_m);
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
