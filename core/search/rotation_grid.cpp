// SPDX-License-Identifier: Apache-2.0
#include "core/search/rotation_grid.h"

#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/geometry/pose.h"

namespace boresight {
namespace {

/// Range of rotations that a sample represents, in spacings: half a spacing of turns, more than
/// half a spacing of tilts, as the nearest samples of several rings do not lie along the box's
/// axes.
constexpr double kTurnReach = 0.5;
constexpr double kTiltReach = 0.6;

/// The factor of the square in the derivative of a rotation vector whose squared length is below
/// kHalfTurn2, a little more than half a turn: it grows with the length.
constexpr double kHalfTurn2 = 10.0;
constexpr double kLeastOfSquare = 0.0833;
constexpr double kMostOfSquare = 0.1017;

}  // namespace

bool isNearBox(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& box_rad,
               const Eigen::Vector3d& slack_rad) {
  const double angle2 = rotation_rad.squaredNorm();
  Eigen::Matrix3d cross;
  cross << 0.0, -rotation_rad.z(), rotation_rad.y(),  //
      rotation_rad.z(), 0.0, -rotation_rad.x(),       //
      -rotation_rad.y(), rotation_rad.x(), 0.0;
  // Derivative of the rotation vector (inverse left Jacobian of the exponential).
  const Eigen::Matrix3d straight = Eigen::Matrix3d::Identity() - 0.5 * cross;
  const Eigen::Matrix3d square = cross * cross;
  const auto isWithin = [&](const Eigen::Matrix3d& slope, double margin_rad) {
    const Eigen::Vector3d reach = box_rad + slope.cwiseAbs() * slack_rad;
    for (int i = 0; i < 3; ++i)
      if (std::abs(rotation_rad[i]) > reach[i] + margin_rad) return false;
    return true;
  };
  // Most rotations are too far off for any of the factors of the square up to half a turn.
  if (angle2 < kHalfTurn2) {
    const Eigen::Matrix3d steepest = (straight + kLeastOfSquare * square)
                                         .cwiseAbs()
                                         .cwiseMax((straight + kMostOfSquare * square).cwiseAbs());
    if (!isWithin(steepest, 1e-9)) return false;
  }
  const double half = 0.5 * std::sqrt(angle2);
  const double of_square = half > 0.01 ? (1.0 - half * cos(half) / sin(half)) / angle2 : 1.0 / 12.0;
  return isWithin(straight + of_square * square, 0.0);
}

int RotationGrid::placesOn(int ring) const {
  const double circumference = count_ * sin(ring * spacing_rad());
  const int places = -static_cast<int>(std::floor(1e-9 - circumference));
  return places > 1 ? places : 1;
}

Eigen::Vector3d RotationGrid::tilt_rad() const {
  const double azimuth = 2.0 * kPi * place_ / placesOn(ring_);
  return ring_ * spacing_rad() * Eigen::Vector3d(cos(azimuth), sin(azimuth), 0.0);
}

bool RotationGrid::next() {
  Turns turned;
  for (int k = 0; k < count_; ++k) nth(turned, k) = rotationExp({0.0, 0.0, k * spacing_rad()});
  while (ring_ <= count_ / 2) {
    if (++place_ >= placesOn(ring_)) {
      place_ = -1;
      ++ring_;
      continue;
    }
    turns_ = turnsWithinReach(turned);
    if (turns_ != 0) return true;
  }
  return false;
}

std::uint64_t RotationGrid::turnsWithinReach(const Turns& turned) const {
  const Eigen::Quaterniond camera_from_view = range_.view_from_camera.conjugate();
  const double tilt_rad = kTiltReach * spacing_rad();
  const Eigen::Vector3d in_view(range_.aside_rad.x() + tilt_rad, range_.aside_rad.y() + tilt_rad,
                                kTurnReach * spacing_rad());
  const Eigen::Vector3d slack_rad = camera_from_view.toRotationMatrix().cwiseAbs() * in_view;
  const Eigen::Quaterniond tilted = rotationExp(this->tilt_rad());
  std::uint64_t turns = 0;
  for (int k = 0; k < count_; ++k) {
    const Eigen::Vector3d rotation_rad = camera_from_view * rotationLog(nth(turned, k) * tilted);
    if (isNearBox(rotation_rad, range_.box_rad, slack_rad)) turns |= std::uint64_t{1} << k;
  }
  return turns;
}

}  // namespace boresight
