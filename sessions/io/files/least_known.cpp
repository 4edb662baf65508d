// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/least_known.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "core/base/math.h"
#include "core/base/symmetric_eigen.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

constexpr double kStandsOut = 5.0;
// Smaller sigmas are not named.
constexpr double kLeast_rad = 0.5 * kDegree_rad;
constexpr double kLeast_m = 1e-3;

/// The direction of a covariance of three axes with the largest sigma, and whether it stands out.
struct Principal {
  double sigma = 0.0;
  Eigen::Vector3d direction_in_camera = Eigen::Vector3d::Zero();
  bool stands_out = false;
};

Principal principalOf(const Eigen::Matrix3d& covariance, double least) {
  const SymmetricEigen<3> eigen(covariance);
  const Eigen::Vector3d sigma = eigen.values.cwiseMax(0.0).cwiseSqrt();
  return {sigma[2], eigen.vectors.col(2), sigma[2] >= least && sigma[2] >= kStandsOut * sigma[1]};
}

/// "z axis", "direction (0.71, 0.71, 0.00)".
std::string directionText(const Eigen::Vector3d& direction) {
  static constexpr std::array<const char*, 3> kAxes = {"x axis", "y axis", "z axis"};
  constexpr double kAlong = 0.985;  // within 10 deg
  Eigen::Index longest = 0;
  direction.cwiseAbs().maxCoeff(&longest);
  if (std::abs(direction[longest]) > kAlong) return kAxes[static_cast<std::size_t>(longest)];
  const Eigen::Vector3d shown = direction[longest] < 0.0 ? Eigen::Vector3d(-direction) : direction;
  const auto part = [&](int axis) {
    return fixedText(std::abs(shown[axis]) < 0.005 ? 0.0 : shown[axis], 2);  // not "-0.00"
  };
  return "direction (" + part(0) + ", " + part(1) + ", " + part(2) + ")";
}

}  // namespace

std::string leastKnownText(const Matrix6d& covariance, const Pose& camera_from_station) {
  if (!covariance.allFinite()) return "";
  const Eigen::Quaterniond station_from_camera = camera_from_station.rotation.conjugate();
  const Eigen::Matrix3d rotation = covariance.topLeftCorner<3, 3>();
  const Principal turn = principalOf(rotation, kLeast_rad);
  if (turn.stands_out)
    return fixedText(turn.sigma / kDegree_rad, 1) + " deg (1 sigma) about the station's " +
           directionText(station_from_camera * turn.direction_in_camera);
  // Slides for a known rotation: they do not depend on the point that is moved.
  const Eigen::FullPivLU<Eigen::Matrix3d> factors(rotation);
  if (!factors.isInvertible()) return "";
  const Eigen::Matrix3d mixed = covariance.bottomLeftCorner<3, 3>();
  const Eigen::Matrix3d alone = covariance.bottomRightCorner<3, 3>() -
                                mixed * factors.solve(Eigen::Matrix3d(mixed.transpose()));
  const Principal slide = principalOf(0.5 * (alone + alone.transpose()), kLeast_m);
  if (!slide.stands_out) return "";
  return fixedText(kMillimetres * slide.sigma, 1) + " mm (1 sigma) along the station's " +
         directionText(station_from_camera * slide.direction_in_camera);
}

}  // namespace boresight::sessions
