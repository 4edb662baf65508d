// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace boresight::sessions {

/// How widely points spread compared with others, in the direction in which they do least: the
/// smallest ratio of both standard deviations over all directions (a generalized eigenvalue). 1
/// when both spread alike, near 0 when the points lie on a line across which the others spread.
/// Both deviations are increased by `floor_px` (squares add), so that others on a line ask for no
/// spread across it. Nothing when there are fewer than two points of either.
std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px);

/// Standard deviation; 0 for fewer than two values.
double deviationOf(std::span<const double> values);

/// The value in the middle, the lower of two; values must not be empty.
double medianOf(std::span<const double> values);

}  // namespace boresight::sessions
