// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/p3p.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/pnp/correspondence.h"

namespace boresight {
namespace {

constexpr int kCubicSteps = 60;
constexpr int kPolishSteps = 8;
constexpr double kCubicDone = 1e-12;         ///< relative step; the next would be its square
constexpr double kPolishDone = 1e-15;        ///< relative step of the depths
constexpr double kAcceptedMismatch = 1e-6;   ///< of squared distances, relative to their sum
constexpr double kSmallestSine = 1e-8;       ///< of the triangle's angle between its longest sides
constexpr double kRoundingTolerance = 1e-9;  ///< of a discriminant that should not be negative

/// The pair equations l_i^2 + l_j^2 - 2 c_ij l_i l_j = a_ij. Corners are renumbered so that
/// (1, 2) is the longest side: it is the common one of the two cones, and a short one would make
/// them nearly equal.
struct Triangle {
  std::array<int, 3> corner{};
  double c01 = 0.0, c02 = 0.0, c12 = 0.0;  ///< cosines between bearings
  double a01 = 0.0, a02 = 0.0, a12 = 0.0;  ///< squared distances over the longest one
  double longest_m = 0.0;
};

double squaredDistance(const std::array<Eigen::Vector3d, 3>& point, int i, int j) {
  return (point[static_cast<std::size_t>(i)] - point[static_cast<std::size_t>(j)]).squaredNorm();
}

bool describe(const std::array<Eigen::Vector3d, 3>& bearing,
              const std::array<Eigen::Vector3d, 3>& point, Triangle& triangle) {
  int opposite = 0;  // corner opposite the longest side
  double longest = squaredDistance(point, 1, 2);
  for (int i = 1; i < 3; ++i) {
    const double squared = squaredDistance(point, (i + 1) % 3, (i + 2) % 3);
    if (squared > longest) {
      longest = squared;
      opposite = i;
    }
  }
  triangle.corner = {opposite, (opposite + 1) % 3, (opposite + 2) % 3};
  const auto& [i, j, k] = triangle.corner;
  const auto& b0 = bearing[static_cast<std::size_t>(i)];
  const auto& b1 = bearing[static_cast<std::size_t>(j)];
  const auto& b2 = bearing[static_cast<std::size_t>(k)];
  const double doubled_area = (point[1] - point[0]).cross(point[2] - point[0]).norm();
  // Written so that a NaN fails.
  if (!(longest > 0.0 && longest < 1e30 && doubled_area > kSmallestSine * longest)) return false;
  triangle.c01 = b0.dot(b1);
  triangle.c02 = b0.dot(b2);
  triangle.c12 = b1.dot(b2);
  triangle.a01 = squaredDistance(point, i, j) / longest;
  triangle.a02 = squaredDistance(point, i, k) / longest;
  triangle.a12 = 1.0;
  triangle.longest_m = std::sqrt(longest);
  const double cosines = std::abs(triangle.c01) + std::abs(triangle.c02) + std::abs(triangle.c12);
  return cosines < 3.0;
}

double determinant(const Eigen::Matrix3d& m) { return m.col(0).dot(m.col(1).cross(m.col(2))); }

/// Adjugate of a symmetric matrix.
Eigen::Matrix3d adjugate(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.row(0) = m.col(1).cross(m.col(2)).transpose();
  result.row(1) = m.col(2).cross(m.col(0)).transpose();
  result.row(2) = m.col(0).cross(m.col(1)).transpose();
  return result;
}

/// Sum of the products of entries: trace(a b) of symmetric matrices.
double traceOfProduct(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) sum += a(i, j) * b(i, j);
  }
  return sum;
}

/// A start at or beyond the real root of t^3 + p t + q that is farthest from 0, on the side where
/// the cubic is monotone and convex, so that Newton's method cannot leave it.
double cubicStart(double p, double q) {
  const double magnitude = std::abs(q);
  // magnitude^(1/4 + 1/16 + 1/64) is close to its cube root, and costs six square roots.
  const double fourth = std::sqrt(std::sqrt(magnitude));
  const double sixteenth = std::sqrt(std::sqrt(fourth));
  const double root = fourth * sixteenth * std::sqrt(std::sqrt(sixteenth));
  const double turning = p < 0.0 ? std::sqrt(-p / 3.0) : 0.0;
  const double start = std::max(2.0 * turning, root);
  return q > 0.0 ? -start : start;
}

/// The real root of x^3 + a x^2 + b x + c that lies farthest from the inflection: it is simple
/// wherever there are three, hence the best conditioned one.
double outerRealRoot(double a, double b, double c) {
  const double shift = a / 3.0;
  const double p = b - a * shift;
  const double q = c - shift * (b - 2.0 * shift * shift);
  double x = cubicStart(p, q) - shift;
  for (int step = 0; step < kCubicSteps; ++step) {
    const double slope = b + x * (2.0 * a + 3.0 * x);
    if (slope == 0.0) break;
    const double change = (c + x * (b + x * (a + x))) / slope;
    x -= change;
    if (!(std::abs(change) > kCubicDone * std::abs(x))) break;
  }
  return x;
}

/// The two cones l' D l = 0 that the triangle's equations leave when the lengths are eliminated.
void makeCones(const Triangle& t, Eigen::Matrix3d& first, Eigen::Matrix3d& second) {
  first << t.a12, -t.a12 * t.c01, 0.0,               //
      -t.a12 * t.c01, t.a12 - t.a01, t.a01 * t.c12,  //
      0.0, t.a01 * t.c12, -t.a01;                    //
  second << t.a12, 0.0, -t.a12 * t.c02,              //
      0.0, -t.a02, t.a02 * t.c12,                    //
      -t.a12 * t.c02, t.a02 * t.c12, t.a12 - t.a02;
}

/// A degenerate cone of the pencil, and one of the two given cones that is well away from it.
struct Pencil {
  Eigen::Matrix3d degenerate;
  Eigen::Matrix3d other;
};

Pencil degenerateMember(Eigen::Matrix3d first, Eigen::Matrix3d second) {
  double lowest = determinant(first);
  double highest = determinant(second);
  // Roots in the ratio whose cubic has the larger leading coefficient: none runs off to infinity.
  if (std::abs(highest) < std::abs(lowest)) {
    std::swap(first, second);
    std::swap(highest, lowest);
  }
  if (highest == 0.0) return {first, second};
  const double linear = traceOfProduct(adjugate(first), second);
  const double quadratic = traceOfProduct(adjugate(second), first);
  const double ratio = outerRealRoot(quadratic / highest, linear / highest, lowest / highest);
  const Eigen::Matrix3d degenerate = first + ratio * second;
  return {degenerate, std::abs(ratio) > 1.0 ? first : second};
}

/// Splits a singular symmetric matrix into planes: l' D l = 0 iff n_0.l = 0 or n_1.l = 0.
/// False when the planes are complex.
bool splitIntoPlanes(const Eigen::Matrix3d& cone, std::array<Eigen::Vector3d, 2>& normal) {
  const double scale = cone.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return false;
  const Eigen::Matrix3d d = cone / scale;
  const Eigen::Matrix3d b = adjugate(d);  // minus the outer square of n_0 x n_1
  int largest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(b(i, i)) > std::abs(b(largest, largest))) largest = i;
  }
  if (b(largest, largest) > kRoundingTolerance) return false;
  Eigen::Matrix3d product = d;  // becomes n_0 n_1' up to scale
  if (b(largest, largest) < 0.0) {
    const Eigen::Vector3d axis = b.col(largest) / std::sqrt(-b(largest, largest));
    product(0, 1) -= axis.z();
    product(0, 2) += axis.y();
    product(1, 0) += axis.z();
    product(1, 2) -= axis.x();
    product(2, 0) -= axis.y();
    product(2, 1) += axis.x();
  }
  int row = 0;
  int col = 0;
  product.cwiseAbs().maxCoeff(&row, &col);
  normal = {product.row(row).transpose(), product.col(col)};
  return true;
}

/// Rays of the plane n.l = 0 that lie on the cone: 0 or 2 directions.
int intersect(const Eigen::Vector3d& normal, const Eigen::Matrix3d& cone,
              std::array<Eigen::Vector3d, 2>& ray) {
  int smallest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) < std::abs(normal[smallest])) smallest = i;
  }
  const Eigen::Vector3d u = normal.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  const Eigen::Vector3d v = normal.cross(u).normalized();
  const double uu = u.dot(cone * u);
  const double uv = u.dot(cone * v);
  const double vv = v.dot(cone * v);
  double discriminant = uv * uv - uu * vv;
  const double scale = uv * uv + std::abs(uu * vv);
  if (!(discriminant >= -kRoundingTolerance * scale)) return 0;
  discriminant = std::max(discriminant, 0.0);
  const double root = uv < 0.0 ? std::sqrt(discriminant) - uv : -std::sqrt(discriminant) - uv;
  ray[0] = root * u + uu * v;
  ray[1] = vv * u + root * v;
  return 2;
}

Eigen::Vector3d mismatch(const Triangle& t, const Eigen::Vector3d& l) {
  return {l[0] * l[0] + l[1] * l[1] - 2.0 * t.c01 * l[0] * l[1] - t.a01,
          l[0] * l[0] + l[2] * l[2] - 2.0 * t.c02 * l[0] * l[2] - t.a02,
          l[1] * l[1] + l[2] * l[2] - 2.0 * t.c12 * l[1] * l[2] - t.a12};
}

/// Newton's method on the three pair equations; the solution is kept unchanged where their
/// Jacobian is singular (a double root).
void polish(const Triangle& t, Eigen::Vector3d& l) {
  for (int step = 0; step < kPolishSteps; ++step) {
    const Eigen::Vector3d r = mismatch(t, l);
    const double j00 = l[0] - t.c01 * l[1], j01 = l[1] - t.c01 * l[0];
    const double j10 = l[0] - t.c02 * l[2], j12 = l[2] - t.c02 * l[0];
    const double j21 = l[1] - t.c12 * l[2], j22 = l[2] - t.c12 * l[1];
    const double det = -j00 * j12 * j21 - j01 * j10 * j22;
    if (det == 0.0) return;
    const double half = 0.5 / det;
    const Eigen::Vector3d change(half * (-j12 * j21 * r[0] - j01 * j22 * r[1] + j01 * j12 * r[2]),
                                 half * (-j10 * j22 * r[0] + j00 * j22 * r[1] - j00 * j12 * r[2]),
                                 half * (j10 * j21 * r[0] - j00 * j21 * r[1] - j01 * j10 * r[2]));
    const Eigen::Vector3d next = l - change;
    const bool better = mismatch(t, next).squaredNorm() <= r.squaredNorm();
    if (!better) return;
    l = next;
    if (change.cwiseAbs().maxCoeff() <= kPolishDone * l.maxCoeff()) return;
  }
}

/// Scales a direction to the triangle's size and polishes it. False unless all depths are positive
/// and the equations hold.
bool depthsAlong(const Triangle& t, const Eigen::Vector3d& ray, Eigen::Vector3d& depths) {
  const double sign = ray.sum() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d direction = sign * ray;
  if (!(direction.minCoeff() > 0.0)) return false;
  const Eigen::Vector3d reached = mismatch(t, direction) + Eigen::Vector3d(t.a01, t.a02, t.a12);
  const double sum = t.a01 + t.a02 + t.a12;
  if (!(reached.sum() > 0.0)) return false;
  depths = direction * std::sqrt(sum / reached.sum());
  polish(t, depths);
  return depths.minCoeff() > 0.0 && mismatch(t, depths).norm() < kAcceptedMismatch * sum;
}

/// Orthonormal axes of a triangle: along its first side, in its plane, and normal to it.
Eigen::Matrix3d triangleAxes(const std::array<Eigen::Vector3d, 3>& point) {
  Eigen::Matrix3d axes;
  const Eigen::Vector3d normal = (point[1] - point[0]).cross(point[2] - point[0]).normalized();
  axes.col(0) = (point[1] - point[0]).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  axes.col(2) = normal;
  return axes;
}

Pose alignTriangles(const std::array<Eigen::Vector3d, 3>& in_camera,
                    const std::array<Eigen::Vector3d, 3>& in_station) {
  const Eigen::Matrix3d rotation = triangleAxes(in_camera) * triangleAxes(in_station).transpose();
  Pose camera_from_station;
  camera_from_station.rotation = Eigen::Quaterniond(rotation).normalized();
  const Eigen::Matrix3d unit = camera_from_station.rotation.toRotationMatrix();
  const Eigen::Vector3d center_in_camera = (in_camera[0] + in_camera[1] + in_camera[2]) / 3.0;
  const Eigen::Vector3d center_in_station = (in_station[0] + in_station[1] + in_station[2]) / 3.0;
  camera_from_station.translation_m = center_in_camera - unit * center_in_station;
  return camera_from_station;
}

}  // namespace

int solveP3p(const std::array<Eigen::Vector3d, 3>& bearing,
             const std::array<Eigen::Vector3d, 3>& point_in_station_m,
             std::array<Pose, 4>& camera_from_station) {
  Triangle triangle;
  if (!describe(bearing, point_in_station_m, triangle)) return 0;
  Eigen::Matrix3d first;
  Eigen::Matrix3d second;
  makeCones(triangle, first, second);
  const Pencil pencil = degenerateMember(first, second);
  std::array<Eigen::Vector3d, 2> normal;
  if (!splitIntoPlanes(pencil.degenerate, normal)) return 0;
  std::size_t count = 0;
  for (const Eigen::Vector3d& plane : normal) {
    std::array<Eigen::Vector3d, 2> ray;
    const int rays = intersect(plane, pencil.other, ray);
    for (int i = 0; i < rays; ++i) {
      Eigen::Vector3d depths;
      if (!depthsAlong(triangle, ray[static_cast<std::size_t>(i)], depths)) continue;
      std::array<Eigen::Vector3d, 3> in_camera;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(triangle.corner[k]);
        in_camera[corner] = depths[static_cast<int>(k)] * triangle.longest_m * bearing[corner];
      }
      const Pose pose = alignTriangles(in_camera, point_in_station_m);
      if (isUsable(pose)) camera_from_station[count++] = pose;
    }
  }
  return static_cast<int>(count);
}

}  // namespace boresight
