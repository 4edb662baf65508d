// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "core/geometry/pose.h"

namespace boresight {

/// Poses that see three points along three bearings: depths l > 0 with
///     |l_i b_i - l_j b_j|^2 = |X_i - X_j|^2   for the three pairs.
/// Two combinations of these are cones in (l_1, l_2, l_3); a degenerate member of their pencil
/// (root of a cubic) splits into two planes, each of which meets the cones in up to two rays
/// (Persson and Nordberg, "Lambda Twist", ECCV 2018; planes from the adjugate as in
/// Richter-Gebert, "Perspectives on Projective Geometry", 2011). The depths are then polished by
/// Newton's method on the three equations.
///
/// `bearing`: unit vectors in the camera frame; `point_in_station_m`: the points, not on a line.
/// Returns how many of `camera_from_station` are filled (0 to 4); every point is in front (l > 0),
/// not necessarily at positive z. 0 when the input is degenerate or not finite.
int solveP3p(const std::array<Eigen::Vector3d, 3>& bearing,
             const std::array<Eigen::Vector3d, 3>& point_in_station_m,
             std::array<Pose, 4>& camera_from_station);

}  // namespace boresight
