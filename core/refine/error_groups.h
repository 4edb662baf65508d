// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/geometry/pose.h"

namespace boresight {

/// Tukey's limit of the errors, in units of their scale: 95 % efficiency on Gaussian errors (Huber
/// 1981). The scale is 1.4826 times their median size, at least `kMinScale_px`.
inline constexpr double kTukey = 4.685;
inline constexpr double kMadToSigma = 1.4826;
inline constexpr double kMinScale_px = 0.15;

/// The scale of errors: kMadToSigma times the median, at least kMinScale_px. `absolute_px`, their
/// absolute values, must not be empty, and is reordered.
double robustScale_px(std::span<float> absolute_px);

/// One measured place on an edge, as it enters a pose.
struct GroupedError {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();   ///< in the box of all places, 0 ... 1
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the edge, in the image
  bool brighter = false;                             ///< the image is brighter along the normal
  std::uint8_t kind = 0;                             ///< EdgeKind bits
  double blur_px = 0.0;                              ///< standard deviation of the edge's blur
};

/// Sums from which the covariance of a pose is computed; those of several views are added.
struct ErrorSums {
  Matrix6d curvature = Matrix6d::Zero();  ///< of half of the robust cost; the lower triangle
  Matrix6d squares = Matrix6d::Zero();    ///< of the sums of errors in the groups
  bool suffices = true;                   ///< every way of grouping has two groups or more

  void add(const ErrorSums& other);  ///< Adds sums of another view
  /// The sums in the perturbation of `camera`'s pose as those of `first`'s; see inFirst() of
  /// NormalEquations.
  ErrorSums inFirst(const Pose& camera_from_first) const;
  /// curvature^-1 squares curvature^-1. False when the curvature is singular, or !suffices.
  [[nodiscard]] bool covariance(Matrix6d& covariance) const;
};

/// The covariance of a robust least-squares pose from its measured residuals, where the residuals
/// are not independent: nearby places share errors of the mesh; edges of one orientation share
/// effects of the light, edges of one kind their rounded corners. Errors are summed within a group
/// before they are squared (the cluster-robust estimator, Liang and Zeger 1986). There are three
/// ways of grouping: 8 x 8 cells; 8 directions by the sign of the gradient; 16 directions by the
/// kind of edge. Their sums are added (Cameron, Gelbach and Miller 2011) without subtracting the
/// intersections: an error alone in all three counts three times, so that the covariance is rather
/// too large. An error common to all edges changes the pose and leaves no residual: an offset
/// outwards (bevels, blur) and a shift of the image along each axis (light from one side, sampling)
/// are added as if measured: of kCommonOffset_px, outwards also of kOffsetOfBlur times the blur,
/// since the steepest place of a blurred edge depends on the tone curve and on its surroundings.
class ErrorGroups {
 public:
  Status create(Arena& arena);  ///< Takes the sums from `arena`. kArenaTooSmall.
  void clear();                 ///< Removes all errors
  /// `slope`: weight times row, which is the derivative of the place along the normal with respect
  /// to the pose.
  void add(const GroupedError& error, double residual_px, const Vector6d& slope);
  /// The squares of the groups, each way of grouping weighted by G / (G - 1) for its G non-empty
  /// groups.
  void sum(ErrorSums& sums) const;

  /// 0 ... 15, of 22.5 degrees each, beginning at +x, towards +y.
  static int sectorOf(const Eigen::Vector2d& direction);

  static constexpr double kCommonOffset_px = 0.05;   ///< common to all edges, one sigma
  static constexpr double kOffsetOfBlur = 0.1;       ///< one sigma
  static constexpr int kCells = 8;                   ///< along each side
  static constexpr int kSectors = 16;                ///< of directions
  static constexpr int kKinds = 8;                   ///< of edges
  static constexpr int kByPlace = kCells * kCells;   ///< groups by place
  static constexpr int kBySide = kSectors;           ///< groups by side: half of the sectors, twice
  static constexpr int kByKind = kSectors * kKinds;  ///< groups by kind

  /// The groups of an error by place, by side and by kind, each from 0.
  static std::array<int, 3> groupsOf(const GroupedError& error);

 private:
  [[nodiscard]] bool addSquares(int first, int count, Matrix6d& squares) const;

  std::span<Vector6d> scores_;      ///< by place, by side, by kind
  std::array<Vector6d, 3> common_;  ///< slopes by an offset outwards, along x and along y
};

}  // namespace boresight
