// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_sigma.h"

#include <cmath>

namespace boresight::sessions {

std::optional<PoseSigma> poseSigma(const Matrix6d& covariance,
                                   const std::optional<Pose>& camera_from_end_effector) {
  if (!covariance.allFinite() || covariance.isZero(0.0)) return std::nullopt;
  const Eigen::Vector3d p =
      camera_from_end_effector ? camera_from_end_effector->translation_m : Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> displacement;           // d = r x p + t
  displacement << 0.0, p.z(), -p.y(), 1.0, 0.0, 0.0,  //
      -p.z(), 0.0, p.x(), 0.0, 1.0, 0.0,              //
      p.y(), -p.x(), 0.0, 0.0, 0.0, 1.0;
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

}  // namespace boresight::sessions
