// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/math.h"

namespace boresight {

/// Rotations within the seed's stated uncertainty, as view directions and turns in the image: each
/// sample is Rz(turn) * T in the view's frame, where T is the shortest rotation that brings the
/// view direction to the view's z axis. View directions lie on rings around that of the seed, a
/// spacing apart along and across the rings; turns are a spacing apart. The spacing is 7.5 deg for
/// boxes of up to 20 deg, grows with larger ones, so that the number of samples does not, and is 15
/// deg from 40 deg on: from a 15 deg grid not every descent reaches the true pose. The whole sphere
/// has 188 directions.
class RotationGrid {
 public:
  static constexpr double kSmallBox_rad =
      20.0 * kDegree_rad;  ///< largest side with the least spacing

  /// Range of a grid.
  struct Range {
    Eigen::Vector3d box_rad = Eigen::Vector3d::Zero();  ///< of rotation vectors, camera axes
    Eigen::Quaterniond view_from_camera = Eigen::Quaterniond::Identity();  ///< axes of the view
    /// About the view's x and y axes: further tilt of objects off the camera's axis.
    Eigen::Vector2d aside_rad = Eigen::Vector2d::Zero();
  };

  RotationGrid() = default;
  /// Starts before the first direction.
  explicit RotationGrid(const Range& range)
      : range_(range), count_(turnsFor(range.box_rad.maxCoeff())) {}

  /// Goes to the next direction of which at least one turn is within reach. False: none is left.
  [[nodiscard]] bool next();
  /// T as a rotation vector in the view's frame; its z is 0.
  Eigen::Vector3d tilt_rad() const;
  /// Number of turns in a full turn.
  int count() const { return count_; }
  /// Angle between neighbouring turns, and view directions.
  double spacing_rad() const { return 2.0 * kPi / count_; }
  /// Bit k: the turn k * spacing_rad() about the view's axis is within reach.
  std::uint64_t turns() const { return turns_; }

 private:
  static constexpr int kMostTurns = 48;
  using Turns = std::array<Eigen::Quaterniond, kMostTurns>;

  static constexpr int kLeastTurns = 24;

  static int turnsFor(double box_rad) {
    const double most = kMostTurns * kSmallBox_rad / std::max(box_rad, kSmallBox_rad);
    return std::max(kLeastTurns, static_cast<int>(most));
  }
  int placesOn(int ring) const;
  std::uint64_t turnsWithinReach(const Turns& turned) const;

  Range range_;
  int count_ = 24;
  int ring_ = 0;
  int place_ = -1;  ///< on the ring
  std::uint64_t turns_ = 0;
};

/// Whether a rotation vector is in the box, or in it after a further rotation by at most
/// `slack_rad` about each axis (to first order; the axes of both are those of the rotation vector).
/// A rotation vector beyond a half turn and the shorter vector of the same rotation give the same
/// result, as the box is symmetric and smaller than a full turn.
bool isNearBox(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& box_rad,
               const Eigen::Vector3d& slack_rad);

}  // namespace boresight
