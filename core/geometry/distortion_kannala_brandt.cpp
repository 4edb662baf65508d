// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/base/math.h"
#include "core/geometry/distortion.h"
#include "core/geometry/polynomial.h"
#include "core/geometry/root_between.h"

namespace boresight {
namespace {

inline double distortedAngle(const Camera& camera, double theta) {
  const auto& k = camera.distortion;
  const double s = theta * theta;
  return theta * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

inline double distortedAngleSlope(const Camera& camera, double theta) {
  const auto& k = camera.distortion;
  const double s = theta * theta;
  return 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * (9.0 * k[3]))));
}

}  // namespace

double kannalaBrandtValidAngle_rad(const Camera& camera) {
  const auto& k = camera.distortion;
  const Polynomial distorted{{0.0, 1.0, 0.0, k[0], 0.0, k[1], 0.0, k[2], 0.0, k[3]}};
  const Polynomial room = Polynomial{{kLargestRadius}} + -1.0 * distorted;
  const double limit = positiveUpTo(room, atan(kLargestRadius));
  return positiveUpTo(distorted.derivative(), limit);
}

bool distortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q) {
  const double r = p.norm();
  const double theta = atan(r);
  if (!(theta <= camera.valid_radius)) return false;
  q = p * (r > 0.0 ? distortedAngle(camera, theta) / r : 1.0);
  return true;
}

bool distortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
                          Eigen::Matrix2d& jacobian) {
  const double r = p.norm();
  const double theta = atan(r);
  if (!(theta <= camera.valid_radius)) return false;
  if (!(r > 0.0)) {
    q = p;
    jacobian.setIdentity();
    return true;
  }
  // q = f(r) n with n = p / r: d q / d p = (f / r) I + (f' - f / r) n n', without cancellation.
  const double ratio = distortedAngle(camera, theta) / r;
  const double slope = distortedAngleSlope(camera, theta) / (1.0 + r * r);
  const Eigen::Vector2d direction = p / r;
  const double excess = slope - ratio;
  q = p * ratio;
  jacobian(0, 0) = ratio + excess * direction.x() * direction.x();
  jacobian(1, 1) = ratio + excess * direction.y() * direction.y();
  jacobian(0, 1) = excess * direction.x() * direction.y();
  jacobian(1, 0) = jacobian(0, 1);
  return true;
}

bool undistortKannalaBrandt(const Camera& camera, const Eigen::Vector2d& q, Eigen::Vector2d& p) {
  const double distorted = q.norm();
  const double limit = camera.valid_radius;
  if (!(distorted <= distortedAngle(camera, limit))) return false;
  const double theta = rootBetween(
      0.0, limit, distorted < limit ? distorted : limit,
      [&](double at) { return distortedAngle(camera, at) - distorted; },
      [&](double at) { return distortedAngleSlope(camera, at); });
  p = distorted > 0.0 ? Eigen::Vector2d(q * (tan(theta) / distorted)) : q;
  return true;
}

}  // namespace boresight
