// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/surface_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kSweeps = 12;  ///< of Jacobi's rotations: convergence is quadratic

/// Makes the element (p, q) of a symmetric matrix 0 (Jacobi 1846).
void rotateToDiagonal(int p, int q, Eigen::Matrix3d& matrix, Eigen::Matrix3d& axes) {
  if (matrix(p, q) == 0.0) return;
  const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * matrix(p, q));
  const double sign = theta < 0.0 ? -1.0 : 1.0;
  const double tangent = sign / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(p, p) = turn(q, q) = cosine;
  turn(p, q) = tangent * cosine;
  turn(q, p) = -tangent * cosine;
  matrix = (turn.transpose() * matrix * turn).eval();
  matrix(p, q) = matrix(q, p) = 0.0;
  axes = (axes * turn).eval();
}

}  // namespace

SurfaceAxes surfaceAxesOf(const MeshView& mesh) {
  const auto forMatched = [&](auto&& take) {
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      if (!mesh.partOf(i).match) continue;
      const Corners corners = mesh.corners(i);
      take(corners, (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm());
    }
  };
  SurfaceAxes surface_axes;
  double area = 0.0;
  forMatched([&](const Corners& corners, double weight) {
    surface_axes.middle_m += weight / 3.0 * (corners[0] + corners[1] + corners[2]);
    area += weight;
  });
  if (!(area > 0.0)) return surface_axes;
  surface_axes.middle_m /= area;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  // The second moment of a triangle about a point is area / 12 times this.
  forMatched([&](const Corners& corners, double weight) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners) {
      const Eigen::Vector3d from = corner - surface_axes.middle_m;
      spread += weight / area * from * from.transpose();
      sum += from;
    }
    spread += weight / area * sum * sum.transpose();
  });
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotateToDiagonal(0, 1, spread, surface_axes.axes);
    rotateToDiagonal(0, 2, spread, surface_axes.axes);
    rotateToDiagonal(1, 2, spread, surface_axes.axes);
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return spread(a, a) < spread(b, b) || (spread(a, a) == spread(b, b) && a < b);
  });
  const Eigen::Matrix3d axes = surface_axes.axes;
  for (int i = 0; i < 3; ++i) surface_axes.axes.col(i) = axes.col(nth(order, i));
  return surface_axes;
}

}  // namespace boresight
