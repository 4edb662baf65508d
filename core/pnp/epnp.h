// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "core/geometry/pose.h"

namespace boresight {

/// The pose that sees points along bearings, from four or more points (EPnP: Lepetit,
/// Moreno-Noguer and Fua, "EPnP: An Accurate O(n) Solution to the PnP Problem", IJCV 2009).
/// Four control points span the points, three where these lie in a plane. The null space of the
/// projection equations gives their places in the camera frame up to one to three factors, which
/// the distances between control points determine; the factors are refined by Gauss-Newton. Of the
/// solutions the one of least reprojection error is returned.
///
/// `bearing`: directions in the camera frame with positive z, any length; `point_in_station_m`: one
/// point per bearing, not all on a line. False when the input is degenerate or not finite, or no
/// solution has the points in front of the camera.
[[nodiscard]] bool solveEpnp(std::span<const Eigen::Vector3d> bearing,
                             std::span<const Eigen::Vector3d> point_in_station_m,
                             Pose& camera_from_station);

}  // namespace boresight
