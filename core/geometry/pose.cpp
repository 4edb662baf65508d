// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose.h"

#include <cmath>
#include <limits>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kLargestDeviation = 1e-4;
/// Newton's iteration squares the deviation in every round: 1e-4, 1e-8, 1e-16, and one to spare.
constexpr int kOrthogonalizationRounds = 4;

/// Products drift from unit length by a rounding error each; renormalizing keeps chains exact.
Eigen::Quaterniond unit(const Eigen::Quaterniond& q) {
  const double norm = std::sqrt((q.w() * q.w() + q.x() * q.x()) + (q.y() * q.y() + q.z() * q.z()));
  return {q.w() / norm, q.x() / norm, q.y() / norm, q.z() / norm};
}

Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.row(0) = m.row(1).cross(m.row(2));
  result.row(1) = m.row(2).cross(m.row(0));
  result.row(2) = m.row(0).cross(m.row(1));
  return result;
}

/// One of the two quaternions of a rotation, for records: w > 0, else the first component that is
/// not zero is positive.
Eigen::Quaterniond canonical(const Eigen::Quaterniond& q) {
  const double decisive =
      q.w() != 0.0 ? q.w() : (q.x() != 0.0 ? q.x() : (q.y() != 0.0 ? q.y() : q.z()));
  return decisive < 0.0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

}  // namespace

Eigen::Vector3d Pose::operator*(const Eigen::Vector3d& point) const {
  return rotation * point + translation_m;
}

Pose Pose::operator*(const Pose& b_from_c) const {
  return {unit(rotation * b_from_c.rotation), rotation * b_from_c.translation_m + translation_m};
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond reverse = rotation.conjugate();
  return {reverse, -(reverse * translation_m)};
}

bool Pose::isFinite() const { return translation_m.allFinite() && rotation.coeffs().allFinite(); }

Eigen::Quaterniond rotationExp(const Eigen::Vector3d& rotation_rad) {
  const double square = rotation_rad.squaredNorm();
  const double angle = std::sqrt(square);
  // sin(angle / 2) / angle; by its series where the quotient would be 0 / 0 or loses digits.
  const double scale = square < 1e-6
                           ? 0.5 - square * (1.0 / 48.0) + square * square * (1.0 / 3840.0)
                           : sin(0.5 * angle) / angle;
  const Eigen::Vector3d vector = scale * rotation_rad;
  return unit({cos(0.5 * angle), vector.x(), vector.y(), vector.z()});
}

Eigen::Vector3d rotationLog(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double w = sign * rotation.w();
  const Eigen::Vector3d vector = sign * rotation.vec();
  const double norm = vector.norm();
  // angle / sin(angle / 2); 2 in the limit, where norm has underflown or is exactly zero.
  const double scale = norm > 0.0 ? 2.0 * atan2(norm, w) / norm : 2.0;
  return scale * vector;
}

Pose perturbed(const Vector6d& xi, const Pose& pose) {
  const Eigen::Quaterniond turn = rotationExp(xi.head<3>());
  return {unit(turn * pose.rotation), turn * pose.translation_m + xi.tail<3>()};
}

Vector6d perturbationBetween(const Pose& from, const Pose& to) {
  const Eigen::Quaterniond turn = unit(to.rotation * from.rotation.conjugate());
  Vector6d xi;
  xi.head<3>() = rotationLog(turn);
  xi.tail<3>() = to.translation_m - turn * from.translation_m;
  return xi;
}

Status poseFromMatrix(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_m,
                      Pose& a_from_b, double& deviation) {
  const Eigen::Matrix3d gram = rotation.transpose() * rotation;
  deviation = (gram - Eigen::Matrix3d::Identity()).norm();
  if (!isFinite(deviation)) deviation = std::numeric_limits<double>::max();
  if (!(deviation <= kLargestDeviation) || !translation_m.allFinite()) return Status::kInvalidPose;
  if (rotation.row(0).dot(rotation.row(1).cross(rotation.row(2))) < 0.0)
    return Status::kInvalidPose;

  // Newton's iteration for the orthogonal polar factor: X <- (X + X^-T) / 2 (Higham 1986).
  Eigen::Matrix3d nearest = rotation;
  for (int round = 0; round < kOrthogonalizationRounds; ++round) {
    const Eigen::Matrix3d cofactor = cofactors(nearest);
    const double determinant = nearest.row(0).dot(cofactor.row(0));
    nearest = (0.5 * (nearest + cofactor / determinant)).eval();
  }
  a_from_b.rotation = canonical(unit(Eigen::Quaterniond(nearest)));
  a_from_b.translation_m = translation_m;
  return Status::kOk;
}

SeedUncertainty scaled(const SeedUncertainty& uncertainty, double factor) {
  SeedUncertainty result = uncertainty;
  result.translation_m *= factor;
  result.rotation_rad *= factor;
  return result;
}

Vector6d offsetAboutPivot(const Pose& camera_from_station_seed, const Pose& camera_from_station,
                          const Eigen::Vector3d& pivot_in_camera_m) {
  const Eigen::Quaterniond turn =
      unit(camera_from_station.rotation * camera_from_station_seed.rotation.conjugate());
  Vector6d offset;
  offset.head<3>() = rotationLog(turn);
  offset.tail<3>() = (camera_from_station.translation_m - pivot_in_camera_m) -
                     turn * (camera_from_station_seed.translation_m - pivot_in_camera_m);
  return offset;
}

Pose displacedAboutPivot(const Pose& camera_from_station_seed, const Vector6d& offset,
                         const Eigen::Vector3d& pivot_in_camera_m) {
  const Eigen::Quaterniond turn = rotationExp(offset.head<3>());
  return {unit(turn * camera_from_station_seed.rotation),
          turn * (camera_from_station_seed.translation_m - pivot_in_camera_m) +
              (pivot_in_camera_m + offset.tail<3>())};
}

}  // namespace boresight
