// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/camera.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/geometry/cahvore.h"
#include "core/geometry/distortion.h"

namespace boresight {
namespace {

/// Far beyond any camera, and far from overflow in what is computed from them.
constexpr double kSmallestFocalLength_px = 1e-6;
constexpr double kLargestPixel = 1e9;
constexpr double kLargestCoefficient = 1e12;

bool plausibleFocalLength(double focal_length_px) {
  return focal_length_px >= kSmallestFocalLength_px && focal_length_px <= kLargestPixel;
}

bool within(double value, double bound) { return value >= -bound && value <= bound; }

/// O within 60 deg of A, and all parameters in the range of real lenses.
bool plausibleLens(const CahvLens& lens) {
  constexpr double kLargestTerm = 1e6;
  constexpr double kLargestLinearity = 10.0;
  for (int i = 0; i < 3; ++i)
    if (!within(lens.radial[i], kLargestTerm) || !within(lens.entrance_m[i], kLargestTerm))
      return false;
  const double length2 = lens.optical_axis.squaredNorm();
  return length2 > 1.0 - 1e-9 && length2 < 1.0 + 1e-9 && lens.optical_axis.z() > 0.5 &&
         within(lens.skew_px, kLargestPixel) && within(lens.linearity, kLargestLinearity);
}

/// The place q where the lens shows the direction p = (x/z, y/z), both on the plane z = 1. False
/// outside the valid field, and for the CAHV family, which has functions of its own.
bool distort(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q) {
  switch (camera.model) {
    case CameraModel::kPinhole:
      q = p;
      return inValidRadius(camera, p);
    case CameraModel::kBrownConrady:
      return distortBrownConrady(camera, p, q);
    case CameraModel::kKannalaBrandt:
      return distortKannalaBrandt(camera, p, q);
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
    case CameraModel::kCahvore:
      break;  // cahvore.h
  }
  return false;
}

/// The same with d q / d p.
bool distort(const Camera& camera, const Eigen::Vector2d& p, Eigen::Vector2d& q,
             Eigen::Matrix2d& q_by_p) {
  switch (camera.model) {
    case CameraModel::kPinhole:
      q = p;
      q_by_p.setIdentity();
      return inValidRadius(camera, p);
    case CameraModel::kBrownConrady:
      return distortBrownConrady(camera, p, q, q_by_p);
    case CameraModel::kKannalaBrandt:
      return distortKannalaBrandt(camera, p, q, q_by_p);
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
    case CameraModel::kCahvore:
      break;  // cahvore.h
  }
  return false;
}

/// The inverse of `distort`.
bool undistort(const Camera& camera, const Eigen::Vector2d& q, Eigen::Vector2d& p) {
  switch (camera.model) {
    case CameraModel::kPinhole:
      p = q;
      return inValidRadius(camera, q);
    case CameraModel::kBrownConrady:
      return undistortBrownConrady(camera, q, p);
    case CameraModel::kKannalaBrandt:
      return undistortKannalaBrandt(camera, q, p);
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
    case CameraModel::kCahvore:
      break;  // cahvore.h
  }
  return false;
}

}  // namespace

Status prepareCamera(Camera& camera) {
  camera.valid_radius = 0.0;
  if (camera.width <= 0 || camera.height <= 0) return Status::kInvalidCamera;
  const bool cahv = isCahvFamily(camera.model);
  if (!plausibleFocalLength(camera.fx) ||
      !plausibleFocalLength(cahv && isMirrored(camera) ? -camera.fy : camera.fy))
    return Status::kInvalidCamera;
  if (cahv && !plausibleLens(camera.cahv)) return Status::kInvalidCamera;
  if (!within(camera.cx, kLargestPixel) || !within(camera.cy, kLargestPixel))
    return Status::kInvalidCamera;
  for (const double coefficient : camera.distortion)
    if (!within(coefficient, kLargestCoefficient)) return Status::kInvalidCamera;

  switch (camera.model) {
    case CameraModel::kPinhole:
      camera.valid_radius = kLargestRadius;
      break;
    case CameraModel::kBrownConrady:
      camera.valid_radius = brownConradyValidRadius(camera);
      break;
    case CameraModel::kKannalaBrandt:
      camera.valid_radius = kannalaBrandtValidAngle_rad(camera);
      break;
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
    case CameraModel::kCahvore:
      camera.valid_radius = prepareCahvLens(camera);
      break;
  }
  return camera.valid_radius > 0.0 ? Status::kOk : Status::kInvalidCamera;
}

bool project(const Camera& camera, const Eigen::Vector3d& point_in_camera_m,
             Eigen::Vector2d& pixel) {
  if (isCahvFamily(camera.model)) return projectCahv(camera, point_in_camera_m, pixel);
  if (!(point_in_camera_m.z() > 0.0)) return false;
  const double inverse_z = 1.0 / point_in_camera_m.z();
  const Eigen::Vector2d p(point_in_camera_m.x() * inverse_z, point_in_camera_m.y() * inverse_z);
  Eigen::Vector2d q;
  if (!distort(camera, p, q)) return false;
  pixel.x() = camera.fx * q.x() + camera.cx;
  pixel.y() = camera.fy * q.y() + camera.cy;
  return true;
}

bool projectWithJacobian(const Camera& camera, const Eigen::Vector3d& point_in_camera_m,
                         Eigen::Vector2d& pixel, Eigen::Matrix<double, 2, 3>& jacobian) {
  if (isCahvFamily(camera.model)) return projectCahv(camera, point_in_camera_m, pixel, jacobian);
  if (!(point_in_camera_m.z() > 0.0)) return false;
  const double inverse_z = 1.0 / point_in_camera_m.z();
  const Eigen::Vector2d p(point_in_camera_m.x() * inverse_z, point_in_camera_m.y() * inverse_z);
  Eigen::Vector2d q;
  Eigen::Matrix2d q_by_p;
  if (!distort(camera, p, q, q_by_p)) return false;
  pixel.x() = camera.fx * q.x() + camera.cx;
  pixel.y() = camera.fy * q.y() + camera.cy;
  // d p / d point = [1 0 -p_x; 0 1 -p_y] / z.
  const Eigen::Vector2d scale(camera.fx * inverse_z, camera.fy * inverse_z);
  for (int row = 0; row < 2; ++row) {
    jacobian(row, 0) = scale[row] * q_by_p(row, 0);
    jacobian(row, 1) = scale[row] * q_by_p(row, 1);
    jacobian(row, 2) = -(jacobian(row, 0) * p.x() + jacobian(row, 1) * p.y());
  }
  return true;
}

bool unproject(const Camera& camera, const Eigen::Vector2d& pixel, Eigen::Vector3d& ray) {
  if (isCahvFamily(camera.model)) {
    Ray with_origin;
    if (!unprojectCahv(camera, pixel, with_origin)) return false;
    ray = with_origin.direction;
    return true;
  }
  const Eigen::Vector2d q((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d p;
  if (!undistort(camera, q, p)) return false;
  ray = {p.x(), p.y(), 1.0};
  return true;
}

bool unprojectRay(const Camera& camera, const Eigen::Vector2d& pixel, Ray& ray) {
  if (isCahvFamily(camera.model)) return unprojectCahv(camera, pixel, ray);
  ray.origin_m.setZero();
  return unproject(camera, pixel, ray.direction);
}

bool projectDirection(const Camera& camera, const Eigen::Vector3d& direction,
                      Eigen::Vector2d& pixel) {
  return camera.model == CameraModel::kCahvore ? projectCahvoreDirection(camera, direction, pixel)
                                               : project(camera, direction, pixel);
}

Eigen::Vector3d seenFromPupil(const Camera& camera, const Eigen::Vector3d& point_in_camera_m) {
  if (!pupilMoves(camera)) return point_in_camera_m;
  return point_in_camera_m - pupilOf(camera, point_in_camera_m) * camera.cahv.optical_axis;
}

Status cutToFrame(int first_x, int first_y, int width, int height, Camera& camera) {
  camera.width = width;
  camera.height = height;
  camera.cx -= first_x;
  camera.cy -= first_y;
  return prepareCamera(camera);
}

Camera cameraAtLevel(const Camera& camera, int level) {
  const int halvings = std::clamp(level, 0, 30);
  const double scale = 1.0 / static_cast<double>(std::int64_t{1} << halvings);
  Camera result = camera;
  result.fx *= scale;
  result.fy *= scale;
  result.cahv.skew_px *= scale;
  result.cx = (camera.cx + 0.5) * scale - 0.5;
  result.cy = (camera.cy + 0.5) * scale - 0.5;
  const auto pooled = [halvings](int size) {
    const std::int64_t rounding = (std::int64_t{1} << halvings) - 1;
    return static_cast<int>((size + rounding) >> halvings);
  };
  result.width = pooled(camera.width);
  result.height = pooled(camera.height);
  return result;
}

}  // namespace boresight
