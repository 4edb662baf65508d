// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/pnp/normal_equations.h"
#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// What a mark says about a pose: two residuals (pixels, seen minus predicted) and how they change.
/// Of a point these are x and y; of a line the distances of its two ends across the projected edge,
/// to first order, with the whole camera model (the interpretation plane of the edge against the
/// rays of the ends: Hartley and Zisserman 2004, 8.1, scaled by the camera's Jacobian).
struct MarkResidual {
  bool valid = false;  ///< false where the pose does not project it
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  /// d predicted / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> predicted_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
  /// Of a line at either end: across the edge, unit length, to where a residual is positive.
  Eigen::Vector2d across[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  double depth_m = 0.0;  ///< of the point, or of the edge's middle
};

MarkResidual markResidual(const MarkedView& view, const MarkAddress& at,
                          const Pose& camera_from_station);

/// Normal equations of all `marks` in xi of rig_from_station; `weight` (one per mark, or empty: all
/// 1) multiplies 1 / sigma^2. A mark that does not project counts as missing.
NormalEquations markEquations(std::span<const MarkedView> views, std::span<const MarkAddress> marks,
                              std::span<const double> weight, const Pose& rig_from_station);

/// Least squares over marks from a start: damped Gauss-Newton steps until one is negligible. False
/// when the marks do not determine the pose there; the pose is then left as it was.
[[nodiscard]] bool refineMarks(std::span<const MarkedView> views,
                               std::span<const MarkAddress> marks, std::span<const double> weight,
                               Pose& rig_from_station, NormalEquations& equations);

}  // namespace boresight::sessions
