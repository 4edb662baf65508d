// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/status.h"

namespace boresight {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A rigid transform. A variable of this type is named `a_from_b` and maps points of b into a:
/// p_a = a_from_b * p_b = rotation * p_b + translation. Metres; the quaternion has unit length.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit length
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();       ///< of b's origin, in a

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;  ///< p_a of a point p_b, metres
  Pose operator*(const Pose& b_from_c) const;  ///< a_from_c; the inner frames must be the same
  Pose inverse() const;                        ///< b_from_a
  /// The rotation as a matrix.
  Eigen::Matrix3d matrix() const { return rotation.toRotationMatrix(); }
  bool isFinite() const;                         ///< whether all numbers are finite
  bool operator==(const Pose&) const = default;  ///< the same numbers, not the same rotation
};

/// The transform of a pose as a rotation matrix, for many points.
struct PoseMatrix {
  Eigen::Matrix3d rotation;       ///< of the pose
  Eigen::Vector3d translation_m;  ///< of the pose

  PoseMatrix() = default;  ///< Without values
  /// The same transform.
  explicit PoseMatrix(const Pose& pose)
      : rotation(pose.matrix()), translation_m(pose.translation_m) {}
  /// p_a of a point p_b, metres.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation_m;
  }
};

/// Rotation by |r| rad about r (Rodrigues), with sin and cos of core/base/math.h.
Eigen::Quaterniond rotationExp(const Eigen::Vector3d& rotation_rad);
/// The rotation vector of a unit quaternion, angle in [0, pi].
Eigen::Vector3d rotationLog(const Eigen::Quaterniond& rotation);

/// `Exp(xi) * pose` with xi = (rotation rad, translation m): p -> rotationExp(r) p + t. This is the
/// left perturbation that all covariances refer to.
Pose perturbed(const Vector6d& xi, const Pose& pose);
/// xi such that perturbed(xi, from) == to.
Vector6d perturbationBetween(const Pose& from, const Pose& to);

/// Nearest rotation to a 3x3 matrix (iterative orthogonalization, no SVD). `deviation` is
/// |R'R - I| (Frobenius) before; kInvalidPose when it exceeds 1e-4, when the determinant is
/// negative, or when anything is not finite.
Status poseFromMatrix(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_m,
                      Pose& a_from_b, double& deviation);

/// Box of poses around a seed, per axis of the seed camera frame:
/// p_true = Exp(r) (p_seed - c) + c + t with |r_i| <= rotation_rad[i], |t_i| <= translation_m[i];
/// c is the pivot in seed-camera coordinates.
struct SeedUncertainty {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Constant(0.03);  ///< half the box, per axis
  /// Half the box, per axis; 5 deg.
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Constant(0.0872664625997);
  Eigen::Vector3d pivot_in_camera_m = Eigen::Vector3d::Zero();  ///< seed camera frame
};

/// The same uncertainty with both boxes scaled.
SeedUncertainty scaled(const SeedUncertainty& uncertainty, double factor);

/// Offset (r, t) of an estimate from a seed about the pivot, as in SeedUncertainty.
Vector6d offsetAboutPivot(const Pose& camera_from_station_seed, const Pose& camera_from_station,
                          const Eigen::Vector3d& pivot_in_camera_m);
/// The pose that offsetAboutPivot would report as `offset`.
Pose displacedAboutPivot(const Pose& camera_from_station_seed, const Vector6d& offset,
                         const Eigen::Vector3d& pivot_in_camera_m);

}  // namespace boresight
