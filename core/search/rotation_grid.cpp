// SPDX-License-Identifier: Apache-2.0
#include "core/search/rotation_grid.h"

#include <cmath>

#include "core/base/math.h"
#include "core/geometry/pose.h"

namespace boresight {
namespace {

constexpr int kRings = RotationGrid::kTurns / 2 + 1;
/// Range of rotations that a sample represents: half a spacing of turns, more than half a spacing
/// of tilts, as the nearest samples of several rings do not lie along the box's axes.
constexpr double kTurnReach_rad = 0.5 * RotationGrid::kSpacing_rad;
constexpr double kTiltReach_rad = 0.6 * RotationGrid::kSpacing_rad;

int placesOn(int ring) {
  const double circumference = RotationGrid::kTurns * sin(ring * RotationGrid::kSpacing_rad);
  const int places = -static_cast<int>(std::floor(1e-9 - circumference));
  return places > 1 ? places : 1;
}

}  // namespace

bool isNearBox(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& box_rad,
               const Eigen::Vector3d& slack_rad) {
  const double angle2 = rotation_rad.squaredNorm();
  const double half = 0.5 * std::sqrt(angle2);
  // Derivative of the rotation vector (inverse left Jacobian of the exponential).
  const double of_square = half > 0.01 ? (1.0 - half * cos(half) / sin(half)) / angle2 : 1.0 / 12.0;
  Eigen::Matrix3d cross;
  cross << 0.0, -rotation_rad.z(), rotation_rad.y(),  //
      rotation_rad.z(), 0.0, -rotation_rad.x(),       //
      -rotation_rad.y(), rotation_rad.x(), 0.0;
  const Eigen::Matrix3d slope =
      Eigen::Matrix3d::Identity() - 0.5 * cross + of_square * (cross * cross);
  const Eigen::Vector3d reach = box_rad + slope.cwiseAbs() * slack_rad;
  for (int i = 0; i < 3; ++i)
    if (std::abs(rotation_rad[i]) > reach[i]) return false;
  return true;
}

Eigen::Vector3d RotationGrid::tilt_rad() const {
  const double azimuth = 2.0 * kPi * place_ / placesOn(ring_);
  return ring_ * kSpacing_rad * Eigen::Vector3d(cos(azimuth), sin(azimuth), 0.0);
}

bool RotationGrid::next() {
  while (ring_ < kRings) {
    if (++place_ >= placesOn(ring_)) {
      place_ = -1;
      ++ring_;
      continue;
    }
    turns_ = turnsWithinReach();
    if (turns_ != 0) return true;
  }
  return false;
}

std::uint32_t RotationGrid::turnsWithinReach() const {
  const Eigen::Quaterniond camera_from_view = range_.view_from_camera.conjugate();
  const Eigen::Vector3d in_view(range_.aside_rad.x() + kTiltReach_rad,
                                range_.aside_rad.y() + kTiltReach_rad, kTurnReach_rad);
  const Eigen::Vector3d slack_rad = camera_from_view.toRotationMatrix().cwiseAbs() * in_view;
  const Eigen::Quaterniond tilted = rotationExp(tilt_rad());
  std::uint32_t turns = 0;
  for (int k = 0; k < kTurns; ++k) {
    const Eigen::Quaterniond turned = rotationExp({0.0, 0.0, k * kSpacing_rad}) * tilted;
    const Eigen::Vector3d rotation_rad = camera_from_view * rotationLog(turned);
    if (isNearBox(rotation_rad, range_.box_rad, slack_rad)) turns |= std::uint32_t{1} << k;
  }
  return turns;
}

}  // namespace boresight
