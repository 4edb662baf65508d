// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/cahvore.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/geometry/distortion.h"
#include "core/geometry/polynomial.h"
#include "core/geometry/root_between.h"

namespace boresight {
namespace {

/// No ray with z > 0 is farther from an optical axis within 60 deg of z.
constexpr double kWidestAngle_rad = 150.0 * kDegree_rad;
/// Below this angle the first terms of the series in theta are exact to rounding.
constexpr double kSmallAngle_rad = 1e-4;

/// A point or direction split by the optical axis.
struct Split {
  double along;            ///< w
  Eigen::Vector3d across;  ///< lam
  double across_length;

  Split(const Camera& camera, const Eigen::Vector3d& point)
      : along(camera.cahv.optical_axis.dot(point)),
        across(point - along * camera.cahv.optical_axis),
        across_length(std::sqrt(across.squaredNorm())) {}
};

/// r0 + r1 s + r2 s^2.
double evenTerms(const Eigen::Vector3d& r, double s) { return r[0] + s * (r[1] + s * r[2]); }
/// d (x (1 + r0 + r1 x^2 + r2 x^4)) / d x.
double radialSlope(const Eigen::Vector3d& r, double x) {
  const double s = x * x;
  return 1.0 + r[0] + s * (3.0 * r[1] + s * (5.0 * r[2]));
}

double chiOf(double linearity, double theta) {
  if (linearity > 0.0) return tan(linearity * theta) / linearity;
  if (linearity < 0.0) return sin(linearity * theta) / linearity;
  return theta;
}
double chiSlope(double linearity, double theta) {
  const double cos_angle = cos(linearity * theta);
  if (linearity > 0.0) return 1.0 / (cos_angle * cos_angle);
  return linearity < 0.0 ? cos_angle : 1.0;
}
double thetaOf(double linearity, double chi) {
  if (linearity > 0.0) return atan(linearity * chi) / linearity;
  if (linearity < 0.0) return asin(linearity * chi) / linearity;
  return chi;
}

/// The equation of the pupil, F(theta) = w sin theta - l cos theta - (theta - sin theta) E(theta),
/// and its slope.
struct PupilEquation {
  double along, across_length;
  const Eigen::Vector3d& entrance_m;

  double value(double theta) const {
    const double sin_theta = sin(theta);
    return along * sin_theta - across_length * cos(theta) -
           (theta - sin_theta) * evenTerms(entrance_m, theta * theta);
  }
  double slope(double theta) const {
    const double s = theta * theta;
    const double sin_theta = sin(theta);
    const double cos_theta = cos(theta);
    const double by_theta = theta * (2.0 * entrance_m[1] + s * (4.0 * entrance_m[2]));
    return along * cos_theta + across_length * sin_theta -
           (1.0 - cos_theta) * evenTerms(entrance_m, s) - (theta - sin_theta) * by_theta;
  }
};

double pupilAt(const Camera& camera, double theta) {
  if (!(theta > 0.0)) return 0.0;
  return (theta / sin(theta) - 1.0) * evenTerms(camera.cahv.entrance_m, theta * theta);
}

/// An interval around the angle of a still pupil in which F changes its sign. There is none within
/// half a radian of points at the pupil itself, which have no one ray.
bool bracket(const PupilEquation& pupil, double start, double limit, double& low, double& high) {
  constexpr double kReach_rad = 0.5;
  low = start > kReach_rad ? start - kReach_rad : 0.0;
  high = start + kReach_rad < limit ? start + kReach_rad : limit;
  return pupil.value(low) <= 0.0 && pupil.value(high) >= 0.0;
}

/// The angle of the ray on which a point lies; false outside the valid field, and for points so
/// near to the pupil that neighbouring rays cross there.
bool solveAngle(const Camera& camera, const Split& split, double& theta) {
  const double limit = camera.valid_radius;
  theta = atan2(split.across_length, split.along);
  const Eigen::Vector3d& e = camera.cahv.entrance_m;
  if (e[0] == 0.0 && e[1] == 0.0 && e[2] == 0.0) return theta <= limit;
  const PupilEquation pupil{split.along, split.across_length, e};
  if (!(theta - limit < kWidestAngle_rad)) return false;  // not a number
  double low = 0.0;
  double high = limit;
  const double start = theta < limit ? theta : limit;
  if (!bracket(pupil, start, limit, low, high)) return false;
  theta = rootBetween(
      low, high, start, [&](double at) { return pupil.value(at); },
      [&](double at) { return pupil.slope(at); });
  const double distance2 = split.along * split.along + split.across_length * split.across_length;
  const double slope = pupil.slope(theta);
  return slope > 0.0 && 4.0 * slope * slope >= distance2;
}

/// d' of a point at the angle theta.
Eigen::Vector3d distortedAt(const Camera& camera, const Split& split, double theta) {
  const CahvLens& lens = camera.cahv;
  const double chi = chiOf(lens.linearity, theta);
  const double along = chi > 0.0 ? split.across_length / chi : split.along;
  return along * lens.optical_axis + (1.0 + evenTerms(lens.radial, chi * chi)) * split.across;
}

bool distortRadially(const Camera& camera, const Split& split, const Eigen::Vector3d& point,
                     Eigen::Vector3d& distorted) {
  if (!(split.along > 0.0)) return false;
  const double tau = split.across.squaredNorm() / (split.along * split.along);
  if (!(tau <= camera.valid_radius * camera.valid_radius)) return false;
  distorted = point + evenTerms(camera.cahv.radial, tau) * split.across;
  return true;
}

/// As unprojected rays are: at most kLargestRadius from the axis of the image plane z = 1.
bool isAhead(const Eigen::Vector3d& point) {
  const double limit = kLargestRadius * point.z();
  return point.z() > 0.0 && point.head<2>().squaredNorm() <= limit * limit;
}

/// The distorted direction on the plane z = 1; false outside the valid field.
bool onImagePlane(const Camera& camera, const Eigen::Vector3d& distorted, Eigen::Vector2d& q) {
  if (!(distorted.z() > 0.0)) return false;
  q = distorted.head<2>() / distorted.z();
  const double limit = camera.model == CameraModel::kCahv ? camera.valid_radius : kLargestRadius;
  return q.squaredNorm() <= limit * limit;
}

Eigen::Vector2d pixelAt(const Camera& camera, const Eigen::Vector2d& q) {
  return {camera.fx * q.x() + camera.cx,
          camera.cahv.skew_px * q.x() + camera.fy * q.y() + camera.cy};
}

/// Pixel of a distorted direction; false outside the valid field.
bool pixelOf(const Camera& camera, const Eigen::Vector3d& distorted, Eigen::Vector2d& pixel) {
  Eigen::Vector2d q;
  if (!onImagePlane(camera, distorted, q)) return false;
  pixel = pixelAt(camera, q);
  return true;
}

using RowVector = Eigen::Matrix<double, 1, 3>;

/// d d' / d point of CAHVOR.
Eigen::Matrix3d radialJacobian(const Camera& camera, const Split& split) {
  const Eigen::Vector3d& axis = camera.cahv.optical_axis;
  const Eigen::Vector3d& r = camera.cahv.radial;
  const double inverse = 1.0 / split.along;
  const double tau = split.across.squaredNorm() * inverse * inverse;
  const RowVector tau_by_point = (2.0 * inverse * inverse) * split.across.transpose() -
                                 (2.0 * tau * inverse) * axis.transpose();
  const Eigen::Matrix3d across_by_point = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  return Eigen::Matrix3d::Identity() + evenTerms(r, tau) * across_by_point +
         (r[1] + 2.0 * r[2] * tau) * split.across * tau_by_point;
}

/// d d' / d point of CAHVORE near the axis, where |lam| / chi = w kappa(theta) with
/// kappa = tan theta / chi; theta d theta stays finite at theta = 0.
Eigen::Matrix3d jacobianNearAxis(const Camera& camera, const Split& split, double theta) {
  const CahvLens& lens = camera.cahv;
  const double l2 = lens.linearity * lens.linearity;
  const double chi_cubic = lens.linearity > 0.0 ? l2 / 3.0 : -l2 / 6.0;
  const double kappa_square = 1.0 / 3.0 - chi_cubic;
  const double s = theta * theta;
  const double along = split.along - lens.entrance_m[0] * s / 6.0;
  const RowVector axis = lens.optical_axis.transpose();
  const RowVector theta_dtheta = (split.across.transpose() / along - s * axis) / along;
  const RowVector along_by_point =
      (1.0 + kappa_square * s) * axis +
      (2.0 * kappa_square * along - lens.entrance_m[0] / 3.0) * theta_dtheta;
  const Eigen::Matrix3d across_by_point = Eigen::Matrix3d::Identity() - lens.optical_axis * axis;
  return lens.optical_axis * along_by_point + (1.0 + evenTerms(lens.radial, s)) * across_by_point +
         (2.0 * lens.radial[1]) * split.across * theta_dtheta;
}

/// d d' / d point of CAHVORE, theta as an implicit function of the point.
Eigen::Matrix3d pupilJacobian(const Camera& camera, const Split& split, double theta) {
  if (theta < kSmallAngle_rad) return jacobianNearAxis(camera, split, theta);
  const CahvLens& lens = camera.cahv;
  const RowVector axis = lens.optical_axis.transpose();
  const RowVector outwards = split.across.transpose() / split.across_length;
  const PupilEquation pupil{split.along, split.across_length, lens.entrance_m};
  const RowVector theta_by_point = (cos(theta) * outwards - sin(theta) * axis) / pupil.slope(theta);
  const double chi = chiOf(lens.linearity, theta);
  const RowVector chi_by_point = chiSlope(lens.linearity, theta) * theta_by_point;
  const RowVector along_by_point =
      outwards / chi - (split.across_length / (chi * chi)) * chi_by_point;
  const double s = chi * chi;
  const double mu_by_chi = chi * (2.0 * lens.radial[1] + s * (4.0 * lens.radial[2]));
  const Eigen::Matrix3d across_by_point = Eigen::Matrix3d::Identity() - lens.optical_axis * axis;
  return lens.optical_axis * along_by_point + (1.0 + evenTerms(lens.radial, s)) * across_by_point +
         (mu_by_chi * split.across) * chi_by_point;
}

/// x with x (1 + r0 + r1 x^2 + r2 x^4) = radius, up to `limit`.
bool solveRadius(const Eigen::Vector3d& r, double radius, double limit, double& x) {
  const auto distorted = [&r](double at) { return at * (1.0 + evenTerms(r, at * at)); };
  if (!(radius <= distorted(limit))) return false;
  x = rootBetween(
      0.0, limit, radius < limit ? radius : limit,
      [&](double at) { return distorted(at) - radius; },
      [&r](double at) { return radialSlope(r, at); });
  return true;
}

/// Largest x up to `limit` such that x (1 + r0 + ...) increases, and stays below kLargestRadius.
double increasingUpTo(const Eigen::Vector3d& r, double limit) {
  const Polynomial distorted{{0.0, 1.0 + r[0], 0.0, r[1], 0.0, r[2]}};
  const Polynomial room = Polynomial{{kLargestRadius}} + -1.0 * distorted;
  return positiveUpTo(distorted.derivative(), positiveUpTo(room, limit));
}

double widestAngle(double linearity) {
  double limit = kWidestAngle_rad;
  if (linearity > 0.0) limit = std::min(limit, atan(kLargestRadius * linearity) / linearity);
  if (linearity < 0.0) limit = std::min(limit, -0.5 * kPi / linearity);
  return limit;
}

/// Range of the pupil for rays in the image and 64 px around it. The angle to O grows outwards,
/// so it is largest in a corner.
void measurePupil(Camera& camera) {
  constexpr double kMargin_px = 64.0;
  constexpr int kSamples = 128;
  CahvLens& lens = camera.cahv;
  double widest = 0.0;
  for (const double x : {-kMargin_px, camera.width - 1 + kMargin_px}) {
    for (const double y : {-kMargin_px, camera.height - 1 + kMargin_px}) {
      Ray ray;
      if (!unprojectCahv(camera, {x, y}, ray)) {
        widest = camera.valid_radius;
        continue;
      }
      const Split split(camera, ray.direction);
      widest = std::max(widest, atan2(split.across_length, split.along));
    }
  }
  double low = 0.0;
  double high = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const double at = pupilAt(camera, widest * i / kSamples);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  // Between samples: a smooth curve exceeds them by far less than a hundredth of its range.
  const double margin = 0.01 * (high - low);
  lens.pupil_low_m = low - margin;
  lens.pupil_high_m = high + margin;
}

}  // namespace

double prepareCahvLens(Camera& camera) {
  CahvLens& lens = camera.cahv;
  lens.pupil_low_m = 0.0;
  lens.pupil_high_m = 0.0;
  if (camera.model == CameraModel::kCahv) return kLargestRadius;
  if (camera.model == CameraModel::kCahvor) return increasingUpTo(lens.radial, kLargestRadius);
  const double widest_rad = widestAngle(lens.linearity);
  const double chi = increasingUpTo(lens.radial, chiOf(lens.linearity, widest_rad));
  if (!(chi > 0.0)) return 0.0;
  camera.valid_radius = std::min(thetaOf(lens.linearity, chi), widest_rad);
  measurePupil(camera);
  return camera.valid_radius;
}

bool projectCahv(const Camera& camera, const Eigen::Vector3d& point, Eigen::Vector2d& pixel) {
  if (!isAhead(point)) return false;
  if (camera.model == CameraModel::kCahv) return pixelOf(camera, point, pixel);
  const Split split(camera, point);
  Eigen::Vector3d distorted;
  if (camera.model == CameraModel::kCahvor)
    return distortRadially(camera, split, point, distorted) && pixelOf(camera, distorted, pixel);
  double theta = 0.0;
  return solveAngle(camera, split, theta) &&
         pixelOf(camera, distortedAt(camera, split, theta), pixel);
}

bool projectCahv(const Camera& camera, const Eigen::Vector3d& point, Eigen::Vector2d& pixel,
                 Eigen::Matrix<double, 2, 3>& jacobian) {
  if (!isAhead(point)) return false;
  const Split split(camera, point);
  Eigen::Vector3d distorted = point;
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Identity();
  if (camera.model == CameraModel::kCahvor) {
    if (!distortRadially(camera, split, point, distorted)) return false;
    by_point = radialJacobian(camera, split);
  } else if (camera.model == CameraModel::kCahvore) {
    double theta = 0.0;
    if (!solveAngle(camera, split, theta)) return false;
    distorted = distortedAt(camera, split, theta);
    by_point = pupilJacobian(camera, split, theta);
  }
  Eigen::Vector2d q;
  if (!onImagePlane(camera, distorted, q)) return false;
  pixel = pixelAt(camera, q);
  const double inverse_z = 1.0 / distorted.z();
  for (int k = 0; k < 3; ++k) {
    const double x_by_point = (by_point(0, k) - q[0] * by_point(2, k)) * inverse_z;
    const double y_by_point = (by_point(1, k) - q[1] * by_point(2, k)) * inverse_z;
    jacobian(0, k) = x_by_point * camera.fx;
    jacobian(1, k) = camera.cahv.skew_px * x_by_point + camera.fy * y_by_point;
  }
  return true;
}

bool projectCahvoreDirection(const Camera& camera, const Eigen::Vector3d& direction,
                             Eigen::Vector2d& pixel) {
  if (!isAhead(direction)) return false;
  const Split split(camera, direction);
  const double theta = atan2(split.across_length, split.along);
  return theta <= camera.valid_radius && pixelOf(camera, distortedAt(camera, split, theta), pixel);
}

bool unprojectCahv(const Camera& camera, const Eigen::Vector2d& pixel, Ray& ray) {
  const CahvLens& lens = camera.cahv;
  const double x = (pixel.x() - camera.cx) / camera.fx;
  const Eigen::Vector2d q(x, (pixel.y() - camera.cy - lens.skew_px * x) / camera.fy);
  ray.origin_m.setZero();
  ray.direction = {q.x(), q.y(), 1.0};
  if (camera.model == CameraModel::kCahv)
    return q.squaredNorm() <= camera.valid_radius * camera.valid_radius;
  const Split split(camera, ray.direction);
  if (!(split.along > 0.0)) return false;
  const bool has_pupil = camera.model == CameraModel::kCahvore;
  const double limit = has_pupil ? chiOf(lens.linearity, camera.valid_radius) : camera.valid_radius;
  double chi = 0.0;
  if (!solveRadius(lens.radial, split.across_length / split.along, limit, chi)) return false;
  const double theta = has_pupil ? thetaOf(lens.linearity, chi) : 0.0;
  const double along = has_pupil ? cos(theta) : 1.0;
  const double across = has_pupil ? sin(theta) : chi;
  Eigen::Vector3d direction = along * lens.optical_axis;
  if (split.across_length > 0.0) direction += split.across * (across / split.across_length);
  if (!(direction.z() > 0.0)) return false;
  ray.direction = {direction.x() / direction.z(), direction.y() / direction.z(), 1.0};
  if (has_pupil) ray.origin_m = pupilAt(camera, theta) * lens.optical_axis;
  const double radius2 = ray.direction.head<2>().squaredNorm();
  return radius2 <= kLargestRadius * kLargestRadius;
}

double pupilOf(const Camera& camera, const Eigen::Vector3d& point) {
  const Split split(camera, point);
  double theta = 0.0;
  if (!solveAngle(camera, split, theta))
    theta = std::min(atan2(split.across_length, split.along), camera.valid_radius);
  const double at = pupilAt(camera, theta);
  return std::clamp(at, camera.cahv.pupil_low_m, camera.cahv.pupil_high_m);
}

}  // namespace boresight
