// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/camera.h"

namespace boresight {

/// The distortion models on the plane z = 1, between a direction p = (x/z, y/z) and the distorted
/// point q with pixel = (fx q_x + cx, fy q_y + cy). A camera must have been prepared; `false` means
/// outside its valid field (or not finite), and then the outputs are unspecified.

/// Limit of |p| and |q|: 0.006 deg off a right angle, beyond any lens. Every pixel stays finite and
/// far from overflow.
inline constexpr double kLargestRadius = 1e4;

/// Whether |p| is at most Camera::valid_radius.
inline bool inValidRadius(const Camera& camera, const Eigen::Vector2d& p) {
  const double limit = camera.valid_radius;
  return p.x() * p.x() + p.y() * p.y() <= limit * limit;
}

/// Brown-Conrady with OpenCV's rational radial factor, s = |p|^2:
///   g(s) = (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3)
///   q = g(s) p + (2 p1 x y + p2 (s + 2 x^2), p1 (s + 2 y^2) + 2 p2 x y)
/// q is the gradient of a function of p, so where its Jacobian is positive definite on a disc the
/// model is one-to-one there: that disc is the valid field.
double brownConradyValidRadius(const Camera& camera);
bool distortBrownConrady(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q);
/// Also d q / d p, symmetric.
bool distortBrownConrady(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
                         Eigen::Matrix2d& jacobian);
bool undistortBrownConrady(const Camera& camera, const Eigen::Vector2d& q, Eigen::Vector2d& p);

/// Kannala-Brandt as in OpenCV's fisheye module, theta = atan |p|:
///   q = (theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9) p / |p|
double kannalaBrandtValidAngle_rad(const Camera& camera);
bool distortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q);
/// Also d q / d p, symmetric.
bool distortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
                          Eigen::Matrix2d& jacobian);
bool undistortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& q, Eigen::Vector2d& p);

}  // namespace boresight
