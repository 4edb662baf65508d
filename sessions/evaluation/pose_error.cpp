// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/math.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

constexpr double kGrossFactor = 3.0;

/// Twist of a rotation about z in (-pi, pi] (swing-twist decomposition).
double twistAboutZ_rad(const Eigen::Quaterniond& rotation) {
  // q and -q are one rotation; w >= 0 keeps the angle within a half turn.
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double twist_rad = 2.0 * atan2(sign * rotation.z(), sign * rotation.w());
  return twist_rad <= -kPi ? twist_rad + 2.0 * kPi : twist_rad;
}

}  // namespace

Eigen::Matrix<double, 3, 6> displacementOf(const Eigen::Vector3d& point_in_camera_m) {
  const Eigen::Vector3d& p = point_in_camera_m;
  Eigen::Matrix<double, 3, 6> displacement;
  displacement << 0.0, p.z(), -p.y(), 1.0, 0.0, 0.0,  //
      -p.z(), 0.0, p.x(), 0.0, 1.0, 0.0,              //
      p.y(), -p.x(), 0.0, 0.0, 0.0, 1.0;
  return displacement;
}

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
  error.rotation_mrad = kMilliradians * atan2(std::hypot(axis.x(), axis.y()), axis.z());
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

const std::array<JudgedFigure, 4> kJudgedFigures = {{
    {&Requirement::normal_mm, [](const PoseError& e) { return std::optional(e.normal_mm); }},
    {&Requirement::lateral_mm, [](const PoseError& e) { return std::optional(e.lateral_mm); }},
    {&Requirement::rotation_deg,
     [](const PoseError& e) {
       return std::optional(e.rotation_mrad / kMilliradians / kDegree_rad);
     }},
    {&Requirement::projection_px, [](const PoseError& e) { return e.projection_px; }},
}};

std::optional<double> rotationLimit_mrad(const Requirement& requirement) {
  if (!requirement.rotation_deg) return std::nullopt;
  return *requirement.rotation_deg * kMradPerDegree;
}

bool meetsRequirement(const PoseError& error, const Requirement& requirement, double factor) {
  return std::all_of(kJudgedFigures.begin(), kJudgedFigures.end(),
                     [&](const JudgedFigure& judged_figure) {
                       const std::optional<double> limit = requirement.*judged_figure.limit;
                       const std::optional<double> value = judged_figure.error(error);
                       return !limit || (value && std::abs(*value) <= factor * *limit);
                     });
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

const char* judgedPlace(const std::optional<Pose>& camera_from_end_effector) {
  return camera_from_end_effector ? "end effector" : "camera";
}

std::optional<PoseSigma> poseSigma(const Matrix6d& covariance,
                                   const std::optional<Pose>& camera_from_end_effector) {
  if (!covariance.allFinite() || covariance.isZero(0.0)) return std::nullopt;
  const Eigen::Matrix<double, 3, 6> displacement = displacementOf(
      camera_from_end_effector ? camera_from_end_effector->translation_m : Eigen::Vector3d::Zero());
  const Eigen::Vector3d moved = (displacement * covariance * displacement.transpose()).diagonal();
  const Eigen::Vector3d turned = covariance.diagonal().head<3>();
  if (moved.minCoeff() < 0.0 || turned.minCoeff() < 0.0) return std::nullopt;
  PoseSigma sigma;
  sigma.translation_mm = 1e3 * moved.cwiseSqrt();
  sigma.rotation_mrad = 1e3 * turned.cwiseSqrt();
  sigma.normal_mm = sigma.translation_mm.z();
  sigma.lateral_mm = std::hypot(sigma.translation_mm.x(), sigma.translation_mm.y());
  sigma.out_of_plane_mrad = std::hypot(sigma.rotation_mrad.x(), sigma.rotation_mrad.y());
  return sigma;
}

std::optional<double> projectionSigma(const Camera& camera, const Pose& camera_from_station,
                                      std::span<const Eigen::Vector3f> points_in_station_m,
                                      const Matrix6d& covariance) {
  double variance = 0.0;
  double seen = 0.0;
  for (const Eigen::Vector3f& point : points_in_station_m) {
    const Eigen::Vector3d p = camera_from_station * point.cast<double>();
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> by_point;
    if (!projectWithJacobian(camera, p, pixel, by_point)) continue;
    const Eigen::Matrix<double, 2, 6> by_pose = by_point * displacementOf(p);
    variance += (by_pose * covariance * by_pose.transpose()).trace();
    seen += 1.0;
  }
  if (seen == 0.0 || !(variance >= 0.0)) return std::nullopt;
  return std::sqrt(variance / seen);
}

double requirementShare(const PoseError& error, const Requirement& requirement) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double share = 0.0;
  for (const JudgedFigure& judged_figure : kJudgedFigures) {
    const std::optional<double> allowed = requirement.*judged_figure.limit;
    const double value = std::abs(judged_figure.error(error).value_or(kInfinite));
    if (allowed) share = std::max(share, *allowed > 0.0 ? value / *allowed : kInfinite);
  }
  return share;
}

std::string sigmaExcessText(const Matrix6d& covariance,
                            const std::optional<Pose>& camera_from_end_effector,
                            const Requirement& requirement) {
  const auto sigma = poseSigma(covariance, camera_from_end_effector);
  if (!sigma) return "";
  const std::string place = std::string(" at the ") + judgedPlace(camera_from_end_effector);
  double most = 1.0;
  std::string text;
  const auto note = [&](double value, const std::optional<double>& allowed, const char* unit,
                        const std::string& where) {
    if (!allowed || !(value > most * *allowed)) return;
    most = value / *allowed;
    text = threeDigits(value) + unit + where + ", " + threeDigits(most) + " times the " +
           threeDigits(*allowed) + unit + " required";
  };
  note(sigma->normal_mm, requirement.normal_mm, " mm", " along the view axis" + place);
  note(sigma->lateral_mm, requirement.lateral_mm, " mm", " across the view axis" + place);
  note(sigma->out_of_plane_mrad / kMradPerDegree, requirement.rotation_deg, " deg",
       " of the view axis");
  return text;
}

}  // namespace boresight::sessions
