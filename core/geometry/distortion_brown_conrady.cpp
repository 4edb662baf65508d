// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/geometry/distortion.h"
#include "core/geometry/polynomial.h"

namespace boresight {
namespace {

constexpr int kMostRadialRounds = 100;
constexpr int kMostNewtonRounds = 40;
constexpr int kMostTries = 30;  // each half as long as the one before
/// On the plane z = 1, times (1 + |q|): reached by Newton's last step, 3e-11 px at 3000 px.
constexpr double kTargetResidual = 1e-14;
/// Largest residual of a solution (the radial factor of a rational model may round worse).
constexpr double kAcceptedResidual = 1e-11;

/// The radial factor g and its derivative by s = |p|^2.
struct Radial {
  double factor;
  double slope;
};

inline Radial radialAt(const Camera& camera, double s) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const double numerator = 1.0 + s * (k1 + s * (k2 + s * k3));
  const double denominator = 1.0 + s * (k4 + s * (k5 + s * k6));
  const double numerator_slope = k1 + s * (2.0 * k2 + s * (3.0 * k3));
  const double denominator_slope = k4 + s * (2.0 * k5 + s * (3.0 * k6));
  const double inverse = 1.0 / denominator;
  const double factor = numerator * inverse;
  return {factor, (numerator_slope - factor * denominator_slope) * inverse};
}

inline double factorAt(const Camera& camera, double s) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  return (1.0 + s * (k1 + s * (k2 + s * k3))) / (1.0 + s * (k4 + s * (k5 + s * k6)));
}

inline void apply(const Camera& camera, double factor, const Eigen::Vector2d& p,
                  Eigen::Vector2d& q) {
  const double p1 = camera.distortion[2];
  const double p2 = camera.distortion[3];
  const double x = p.x();
  const double y = p.y();
  const double s = x * x + y * y;
  const double xy = 2.0 * x * y;
  q.x() = x * factor + (p1 * xy + p2 * (s + 2.0 * x * x));
  q.y() = y * factor + (p1 * (s + 2.0 * y * y) + p2 * xy);
}

inline void applyWithJacobian(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
                              Eigen::Matrix2d& jacobian) {
  const double p1 = camera.distortion[2];
  const double p2 = camera.distortion[3];
  const double x = p.x();
  const double y = p.y();
  const Radial radial = radialAt(camera, x * x + y * y);
  apply(camera, radial.factor, p, q);
  const double slope = 2.0 * radial.slope;
  jacobian(0, 0) = radial.factor + slope * x * x + (2.0 * p1 * y + 6.0 * p2 * x);
  jacobian(1, 1) = radial.factor + slope * y * y + (6.0 * p1 * y + 2.0 * p2 * x);
  jacobian(0, 1) = slope * x * y + 2.0 * (p1 * x + p2 * y);
  jacobian(1, 0) = jacobian(0, 1);
}

/// r with r g(r^2) = distorted, or the valid radius when there is none in the field: a start for
/// the plane, so close that only the tangential terms are left to find. Newton, kept between bounds
/// because the slope may vanish at the end of the valid field.
double radialSolution(const Camera& camera, double distorted) {
  double low = 0.0;
  double high = camera.valid_radius;
  double r = distorted < high ? distorted : high;
  for (int round = 0; round < kMostRadialRounds; ++round) {
    const double s = r * r;
    const Radial radial = radialAt(camera, s);
    const double excess = r * radial.factor - distorted;
    if (std::abs(excess) <= kTargetResidual * (1.0 + distorted)) break;
    (excess > 0.0 ? high : low) = r;
    if (!(high > low)) break;
    const double next = r - excess / (radial.factor + 2.0 * s * radial.slope);
    if (next == r) break;
    r = next > low && next < high ? next : 0.5 * (low + high);
  }
  return r;
}

}  // namespace

double brownConradyValidRadius(const Camera& camera) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  // In r = |p|: the numerator N and denominator D of g, and D^2 d(r g)/dr = N D + r (N'D - N D').
  const Polynomial numerator{{1.0, 0.0, k1, 0.0, k2, 0.0, k3}};
  const Polynomial denominator{{1.0, 0.0, k4, 0.0, k5, 0.0, k6}};
  const Polynomial radius{{0.0, 1.0}};
  const Polynomial tangential_slope = numerator * denominator;
  const Polynomial radial_slope =
      tangential_slope + radius * (numerator.derivative() * denominator +
                                   -1.0 * (numerator * denominator.derivative()));
  // With m = |(p1, p2)| r, a and b the radial and tangential slope, and c the cosine between p and
  // (p2, p1), the Jacobian is [a + 6 m c, 2 m w; 2 m w, b + 2 m c], w^2 = 1 - c^2. For a > 6 m and
  // b > 10/3 m its determinant is least at c = -1, (a - 6 m) (b - 2 m): positive.
  const double tangential = std::sqrt(p1 * p1 + p2 * p2);
  const Polynomial loss = -tangential * (radius * (denominator * denominator));

  // N D > 0 from the centre on includes D > 0: no pole.
  double limit = positiveUpTo(tangential_slope + (10.0 / 3.0) * loss, kLargestRadius);
  limit = positiveUpTo(kLargestRadius * denominator + -1.0 * (radius * numerator), limit);
  return positiveUpTo(radial_slope + 6.0 * loss, limit);
}

bool distortBrownConrady(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q) {
  if (!inValidRadius(camera, p)) return false;
  apply(camera, factorAt(camera, p.x() * p.x() + p.y() * p.y()), p, q);
  return true;
}

bool distortBrownConrady(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
                         Eigen::Matrix2d& jacobian) {
  if (!inValidRadius(camera, p)) return false;
  applyWithJacobian(camera, p, q, jacobian);
  return true;
}

bool undistortBrownConrady(const Camera& camera, const Eigen::Vector2d& q, Eigen::Vector2d& p) {
  const double distorted = q.norm();
  if (!(distorted <= 2.0 * kLargestRadius)) return false;
  p = distorted > 0.0 ? Eigen::Vector2d(q * (radialSolution(camera, distorted) / distorted)) : q;

  Eigen::Vector2d at_p;
  Eigen::Matrix2d jacobian;
  applyWithJacobian(camera, p, at_p, jacobian);
  Eigen::Vector2d residual = q - at_p;
  double size = residual.norm();
  for (int round = 0; round < kMostNewtonRounds; ++round) {
    if (size <= kTargetResidual * (1.0 + distorted)) break;
    const double determinant = jacobian(0, 0) * jacobian(1, 1) - jacobian(0, 1) * jacobian(1, 0);
    Eigen::Vector2d step(
        (jacobian(1, 1) * residual.x() - jacobian(0, 1) * residual.y()) / determinant,
        (jacobian(0, 0) * residual.y() - jacobian(1, 0) * residual.x()) / determinant);
    // Newton's direction lowers the residual if the step is short enough; no further gain means
    // that rounding is reached, or that there is no solution.
    const int tries = size <= kAcceptedResidual * (1.0 + distorted) ? 1 : kMostTries;
    bool better = false;
    for (int attempt = 0; attempt < tries && !better; ++attempt) {
      const Eigen::Vector2d candidate = p + step;
      applyWithJacobian(camera, candidate, at_p, jacobian);
      const Eigen::Vector2d candidate_residual = q - at_p;
      const double candidate_size = candidate_residual.norm();
      better = candidate_size < size && inValidRadius(camera, candidate);
      if (better) {
        p = candidate;
        residual = candidate_residual;
        size = candidate_size;
      }
      step *= 0.5;
    }
    if (!better) break;
  }
  return size <= kAcceptedResidual * (1.0 + distorted);
}

}  // namespace boresight
