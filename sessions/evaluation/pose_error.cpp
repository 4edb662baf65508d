// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_error.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight::sessions {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMilliradians = 1e3;
constexpr double kGrossFactor = 3.0;

/// Twist of a rotation about z in (-pi, pi] (swing-twist decomposition).
double twistAboutZ_rad(const Eigen::Quaterniond& rotation) {
  // q and -q are one rotation; w >= 0 keeps the angle within a half turn.
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double twist_rad = 2.0 * arcTangent2(sign * rotation.z(), sign * rotation.w());
  return twist_rad <= -kPi ? twist_rad + 2.0 * kPi : twist_rad;
}

}  // namespace

PoseError poseError(const Pose& camera_from_station_true, const Pose& camera_from_station_estimated,
                    const std::optional<Pose>& camera_from_end_effector) {
  const Pose true_from_estimated =
      camera_from_station_true * camera_from_station_estimated.inverse();
  const Eigen::Vector3d effector_m =
      camera_from_end_effector ? camera_from_end_effector->translation_m : Eigen::Vector3d::Zero();
  const Eigen::Vector3d d_m = true_from_estimated * effector_m - effector_m;
  const Eigen::Vector3d axis = true_from_estimated.matrix().col(2);

  PoseError error;
  error.normal_mm = kMillimetres * d_m.z();
  error.lateral_mm = kMillimetres * std::hypot(d_m.x(), d_m.y());
  // atan2 keeps small angles exact where acos of the dot product would not.
  error.rotation_mrad = kMilliradians * arcTangent2(std::hypot(axis.x(), axis.y()), axis.z());
  error.in_plane_mrad = kMilliradians * twistAboutZ_rad(true_from_estimated.rotation);
  error.geodesic_mrad = kMilliradians * rotationLog(true_from_estimated.rotation).norm();
  return error;
}

std::optional<double> projectionError(const Camera& camera, const Pose& camera_from_station_true,
                                      const Pose& camera_from_station_estimated,
                                      std::span<const Eigen::Vector3f> vertices_in_station_m) {
  const double diagonal_px = std::hypot(camera.width, camera.height);
  double sum_px = 0.0;
  std::int64_t count = 0;
  for (const Eigen::Vector3f& vertex : vertices_in_station_m) {
    const Eigen::Vector3d point_in_station_m = vertex.cast<double>();
    Eigen::Vector2d true_px;
    Eigen::Vector2d estimated_px;
    if (!project(camera, camera_from_station_true * point_in_station_m, true_px)) continue;
    const bool projected =
        project(camera, camera_from_station_estimated * point_in_station_m, estimated_px);
    sum_px += projected ? (estimated_px - true_px).norm() : diagonal_px;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum_px / static_cast<double>(count);
}

bool meetsRequirement(const PoseError& error, const Requirement& requirement, double factor) {
  const auto within = [factor](const std::optional<double>& limit, double value) {
    return !limit || std::abs(value) <= factor * *limit;
  };
  if (requirement.projection_px && !error.projection_px) return false;
  const double rotation_deg = error.rotation_mrad / kMilliradians / kDegree_rad;
  return within(requirement.normal_mm, error.normal_mm) &&
         within(requirement.lateral_mm, error.lateral_mm) &&
         within(requirement.rotation_deg, rotation_deg) &&
         within(requirement.projection_px, error.projection_px.value_or(0.0));
}

bool isGross(const PoseError& error, const Requirement& requirement) {
  return !meetsRequirement(error, requirement, kGrossFactor);
}

Statistics statistics(std::span<const double> values) {
  Statistics result;
  result.count = static_cast<std::int64_t>(values.size());
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) {
    result.mean += value / count;
    result.maximum = std::max(result.maximum, std::abs(value));
  }
  double variance = 0.0;
  for (const double value : values)
    variance += (value - result.mean) * (value - result.mean) / count;
  result.deviation = std::sqrt(variance);
  return result;
}

}  // namespace boresight::sessions
