// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_view.h"

namespace boresight {

/// H xi = g of weighted least squares in the left perturbation xi = (rotation rad, translation m)
/// of a pose, with the weighted squares at the pose itself.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();  ///< H; only the lower triangle is filled
  Vector6d gradient = Vector6d::Zero();     ///< g = J' W (observed - predicted)
  double squares = 0.0;                     ///< sum of ((pixel - projection) / sigma)^2
  double prior_squares = 0.0;               ///< the prior's part of the squares
  std::int32_t projected = 0;               ///< correspondences included
  std::int32_t missing = 0;                 ///< correspondences used that do not project here

  /// Cost that a step must lower: a correspondence that stops projecting costs more than any
  /// residual, so that no step gains by moving points behind the camera.
  double cost() const;
};

/// Sums the reprojection terms of the correspondences whose `use` is nonzero (all when empty) in
/// their order. Row of a point p in the camera frame with image Jacobian a (px/m): [p x a, a].
NormalEquations reprojectionEquations(std::span<const Correspondence> correspondences,
                                      std::span<const std::uint8_t> use, const Camera& camera,
                                      const Pose& camera_from_station);

/// The same over several views, in the perturbation of the first one's pose: the sum of the views'
/// equations, transformed by `inFirst`.
NormalEquations reprojectionEquations(std::span<const Correspondence> correspondences,
                                      std::span<const std::uint8_t> use,
                                      std::span<const PnpView> views,
                                      const Pose& first_from_station);

/// To first order Exp(A xi) * (a_from_b * pose) = a_from_b * (Exp(xi) * pose): the matrix A that
/// brings perturbations of poses b_from_station to those of a_from_station. With R, t of a_from_b
/// its rows are [R, 0] (rotation) and [[t]x R, R] (translation).
Matrix6d adjointOf(const Pose& a_from_b);
/// The covariance of perturbations in frame b as one in frame a.
Matrix6d covarianceIn(const Pose& a_from_b, const Matrix6d& covariance_in_b);
/// Equations in the perturbation of `camera`'s pose as equations in that of `first`'s:
/// A' H A and A' g with A = adjointOf(camera_from_first). Sums and counts stay.
NormalEquations inFirst(const NormalEquations& equations, const Pose& camera_from_first);
/// Adds a measurement of one dimension: `row` is the derivative of its prediction with respect to
/// xi, `residual` is measured minus predicted.
void addRow(const Vector6d& row, double weight, double residual, NormalEquations& sum);
/// Row of a point on a line in the image: d (normal . pixel) / d xi for p -> p + r x p + t, with
/// the Jacobian of the camera at p (px/m).
Vector6d lineRow(const Eigen::Vector3d& point_in_camera_m, const Eigen::Vector2d& normal,
                 const Eigen::Matrix<double, 2, 3>& jacobian);
/// Adds H, g, sums and counts.
void addTo(NormalEquations& sum, const NormalEquations& equations);

/// Adds ((offset about the pivot) / sigma)^2. Rows: d r = Jl(r)^-1 omega, with the inverse left
/// Jacobian of the rotation group to second order in r (relative error |r|^4 / 720), and exactly
/// d t = omega x (c + t) + v.
void addPrior(const PosePrior& prior, const Pose& camera_from_station, NormalEquations& equations);

/// Solves (H + damping * diag H) xi = g by a pivoted LDL' factorization of H scaled to a unit
/// diagonal. False when a pivot falls below 1e-12: some direction is not determined.
[[nodiscard]] bool solve(const NormalEquations& equations, double damping, Vector6d& xi);

/// H^-1, symmetric. False as above.
[[nodiscard]] bool invert(const Matrix6d& information, Matrix6d& covariance);

}  // namespace boresight
