// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_sigma.h"

#include <cmath>

namespace boresight::sessions {
namespace {

/// How a point of the camera frame moves: d = r x p + t.
Eigen::Matrix<double, 3, 6> displacementOf(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 6> displacement;
  displacement << 0.0, p.z(), -p.y(), 1.0, 0.0, 0.0,  //
      -p.z(), 0.0, p.x(), 0.0, 1.0, 0.0,              //
      p.y(), -p.x(), 0.0, 0.0, 0.0, 1.0;
  return displacement;
}

}  // namespace

const char* judgedPlace(const std::optional<Pose>& camera_from_end_effector) {
  return camera_from_end_effector ? "end effector" : "camera";
}

std::optional<PoseSigma> poseSigma(const Matrix6d& covariance,
                                   const std::optional<Pose>& camera_from_end_effector) {
  if (!covariance.allFinite() || covariance.isZero(0.0)) return std::nullopt;
  const Eigen::Matrix<double, 3, 6> displacement = displacementOf(
      camera_from_end_effector ? camera_from_end_effector->translation_m : Eigen::Vector3d::Zero());
  const Eigen::Vector3d moved = (displacement * covariance * displacement.transpose()).diagonal();
  const Eigen::Vector3d turned = covariance.diagonal().head<3>();
  if (moved.minCoeff() < 0.0 || turned.minCoeff() < 0.0) return std::nullopt;
  PoseSigma sigma;
  sigma.translation_mm = 1e3 * moved.cwiseSqrt();
  sigma.rotation_mrad = 1e3 * turned.cwiseSqrt();
  sigma.normal_mm = sigma.translation_mm.z();
  sigma.lateral_mm = std::hypot(sigma.translation_mm.x(), sigma.translation_mm.y());
  sigma.out_of_plane_mrad = std::hypot(sigma.rotation_mrad.x(), sigma.rotation_mrad.y());
  return sigma;
}

std::optional<double> projectionSigma(const Camera& camera, const Pose& camera_from_station,
                                      std::span<const Eigen::Vector3f> points_in_station_m,
                                      const Matrix6d& covariance) {
  double variance = 0.0;
  double seen = 0.0;
  for (const Eigen::Vector3f& point : points_in_station_m) {
    const Eigen::Vector3d p = camera_from_station * point.cast<double>();
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> by_point;
    if (!projectWithJacobian(camera, p, pixel, by_point)) continue;
    const Eigen::Matrix<double, 2, 6> by_pose = by_point * displacementOf(p);
    variance += (by_pose * covariance * by_pose.transpose()).trace();
    seen += 1.0;
  }
  if (seen == 0.0 || !(variance >= 0.0)) return std::nullopt;
  return std::sqrt(variance / seen);
}

}  // namespace boresight::sessions
