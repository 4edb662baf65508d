// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_field.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr double kWide_rad = 80.0 * kDegree_rad;
constexpr double kMostWithoutRay = 0.25;
constexpr int kGrid = 16;

/// From the optical axis to the end of the valid field.
double fieldAngle_rad(const Camera& camera) {
  switch (camera.model) {
    case CameraModel::kPinhole:
    case CameraModel::kBrownConrady:
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
      return std::atan(camera.valid_radius);
    case CameraModel::kKannalaBrandt:
    case CameraModel::kCahvore:
      return camera.valid_radius;
  }
  return std::nan("");
}

/// The same in the image, to the right of the axis, px.
double fieldRadius_px(const Camera& camera, double angle_rad) {
  const Eigen::Vector3d axis = camera.cahv.optical_axis;
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(axis).normalized();
  Eigen::Vector2d middle, end;
  const double inside_rad = angle_rad * (1.0 - 1e-9);
  if (!projectDirection(camera, axis, middle) ||
      !projectDirection(camera, std::cos(inside_rad) * axis + std::sin(inside_rad) * right, end))
    return std::nan("");
  return (end - middle).norm();
}

double shareWithoutRay(const Camera& camera) {
  int without = 0;
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column) {
      const Eigen::Vector2d pixel((column + 0.5) * camera.width / kGrid - 0.5,
                                  (row + 0.5) * camera.height / kGrid - 0.5);
      Eigen::Vector3d ray;
      if (!unproject(camera, pixel, ray)) ++without;
    }
  return static_cast<double>(without) / (kGrid * kGrid);
}

}  // namespace

std::string fieldConcern(const Camera& camera) {
  const double angle_rad = fieldAngle_rad(camera);
  if (angle_rad >= kWide_rad) return "";
  const double share = shareWithoutRay(camera);
  if (share <= kMostWithoutRay) return "";
  return formatText(
      "the distortion folds back %.1f deg off the optical axis, %.0f px from it, and "
      "%.0f %% of the image lie beyond: check the coefficients' order and signs",
      angle_rad / kDegree_rad, fieldRadius_px(camera, angle_rad), 100.0 * share);
}

void requireField(const std::filesystem::path& file, const std::string& field,
                  const Camera& camera) {
  const std::string concern = fieldConcern(camera);
  if (!concern.empty()) throw InputError(file, field, concern);
}

}  // namespace boresight::sessions
