// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/math.h"

namespace boresight {

/// Rotations about a seed's that its stated uncertainty reaches, as view directions and turns in
/// the image: each sample is Rz(turn) * T in the view's frame, where T is the shortest rotation
/// that brings the view direction to the view's z axis. View directions lie on rings around the
/// seed's, kSpacing_rad apart along and across the rings; turns are kSpacing_rad apart. The whole
/// sphere has 188 directions.
class RotationGrid {
 public:
  static constexpr int kTurns = 24;                           ///< of a full turn
  static constexpr double kSpacing_rad = 2.0 * kPi / kTurns;  ///< 15 deg

  /// Range of a grid.
  struct Range {
    Eigen::Vector3d box_rad = Eigen::Vector3d::Zero();  ///< of rotation vectors, camera axes
    Eigen::Quaterniond view_from_camera = Eigen::Quaterniond::Identity();  ///< axes of the view
    /// About the view's x and y axes: further tilt of objects off the camera's axis.
    Eigen::Vector2d aside_rad = Eigen::Vector2d::Zero();
  };

  RotationGrid() = default;
  /// Starts before the first direction.
  explicit RotationGrid(const Range& range) : range_(range) {}

  /// Goes to the next direction of which at least one turn is within reach. False: none is left.
  [[nodiscard]] bool next();
  /// T as a rotation vector in the view's frame; its z is 0.
  Eigen::Vector3d tilt_rad() const;
  /// Bit k: the turn k * kSpacing_rad about the view's axis is within reach.
  std::uint32_t turns() const { return turns_; }

 private:
  std::uint32_t turnsWithinReach() const;

  Range range_;
  int ring_ = 0;
  int place_ = -1;  ///< on the ring
  std::uint32_t turns_ = 0;
};

/// Whether a rotation vector is in the box, or in it after a further rotation by at most
/// `slack_rad` about each axis (to first order; the axes of both are those of the rotation vector).
/// A rotation vector beyond a half turn and the shorter one of the same rotation are both in the
/// box or both are not, as the box is symmetric and smaller than a full turn.
bool isNearBox(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& box_rad,
               const Eigen::Vector3d& slack_rad);

}  // namespace boresight
