// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/geometry/pose.h"

namespace boresight {

/// One measured place on an edge, as it enters a pose.
struct GroupedError {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();   ///< in the box of all places, 0 ... 1
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the edge, in the image
  bool brighter = false;                             ///< along the normal, as the image has it
  std::uint8_t kind = 0;                             ///< EdgeKind bits
};

/// The covariance of a robust least-squares pose from its measured residuals, where these are not
/// independent: places near each other share what the mesh does not know of the part; edges that
/// look the same way share what the light makes of them, those of one kind their rounded corners.
/// Errors are summed up within a group before they are squared (the cluster-robust estimator, Liang
/// and Zeger 1986), in three ways of grouping, whose sums are added (Cameron, Gelbach and Miller
/// 2011, without subtracting what the ways have in common: an error that is alone in all three
/// counts three times, so that this errs to the large side):
/// 8 x 8 cells; 8 directions by the sign of the gradient; 16 directions by the kind of edge.
class ErrorGroups {
 public:
  Status create(Arena& arena);  ///< Takes the sums from `arena`. kArenaTooSmall.
  void clear();                 ///< Forgets all errors
  /// `score`: the derivative of half of the robust cost with respect to the pose, weight times
  /// residual times row.
  void add(const GroupedError& error, const Vector6d& score);
  /// curvature^-1 (sum of squares of groups) curvature^-1, each way of grouping G / (G - 1) times
  /// for its G groups that hold something. False when the curvature is singular, or a way has fewer
  /// than two groups.
  [[nodiscard]] bool covariance(const Matrix6d& curvature, Matrix6d& covariance) const;

  /// 0 ... 15, of 22.5 degrees each, beginning at +x, towards +y.
  static int sectorOf(const Eigen::Vector2d& direction);

 private:
  static constexpr int kCells = 8;  ///< along each side
  static constexpr int kSectors = 16;
  static constexpr int kKinds = 8;
  static constexpr int kByPlace = kCells * kCells;
  static constexpr int kBySide = kSectors;  ///< half of the sectors, twice
  static constexpr int kByKind = kSectors * kKinds;

  [[nodiscard]] bool addSquares(int first, int count, Matrix6d& squares) const;

  std::span<Vector6d> scores_;  ///< by place, by side, by kind
};

}  // namespace boresight
