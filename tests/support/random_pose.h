// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ostream>
#include <string_view>

#include <gmock/gmock.h>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

/// Random but repeatable cameras and poses for tests, and a matcher that says by how much two poses
/// differ.
namespace boresight {

/// Found by argument-dependent lookup when a test prints a pose.
inline void PrintTo(const Pose& pose, std::ostream* out) {
  const Eigen::Vector3d rotation_deg = rotationLog(pose.rotation) / kDegree_rad;
  *out << "rotation vector (" << rotation_deg.transpose() << ") deg, translation ("
       << pose.translation_m.transpose() << ") m";
}

namespace test {

/// A generator keyed by a name (FNV-1a), usually the test's: adding a test does not change the
/// numbers of the others.
inline Random randomFor(std::string_view name) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return Random(hash);
}

/// Components uniform in [-bound, bound].
inline Eigen::Vector3d randomVector(Random& random, double bound) {
  const double x = random.uniform(-bound, bound);
  const double y = random.uniform(-bound, bound);
  const double z = random.uniform(-bound, bound);
  return {x, y, z};
}

/// Components of deviation 1.
inline Vector6d normalVector6(Random& random) {
  Vector6d vector;
  for (int i = 0; i < 6; ++i) vector[i] = random.normal();
  return vector;
}

/// Uniform on the unit sphere.
inline Eigen::Vector3d randomDirection(Random& random) {
  for (;;) {
    const Eigen::Vector3d v = randomVector(random, 1.0);
    if (v.norm() > 0.01 && v.norm() <= 1.0) return v.normalized();
  }
}

/// Uniform over all rotations.
inline Eigen::Quaterniond randomRotation(Random& random) {
  const double w = random.normal();
  const double x = random.normal();
  const double y = random.normal();
  const double z = random.normal();
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

/// Any rotation, translation components uniform in [-bound_m, bound_m].
inline Pose randomPose(Random& random, double bound_m = 1.0) {
  Pose pose;
  pose.rotation = randomRotation(random);
  pose.translation_m = randomVector(random, bound_m);
  return pose;
}

/// A station that the camera sees: any rotation, its origin `distance_m` away, at most
/// `off_axis_rad` from the optical axis.
inline Pose randomCameraFromStation(Random& random, double distance_m, double off_axis_rad = 0.05) {
  Pose camera_from_station;
  camera_from_station.rotation = randomRotation(random);
  const double azimuth_rad = random.uniform(-kPi, kPi);
  const double off_rad = random.uniform(0.0, off_axis_rad);
  camera_from_station.translation_m =
      distance_m * Eigen::Vector3d(sin(off_rad) * cos(azimuth_rad), sin(off_rad) * sin(azimuth_rad),
                                   cos(off_rad));
  return camera_from_station;
}

/// A displacement inside the boxes of an uncertainty: (rotation rad, translation m).
inline Vector6d randomOffset(Random& random, const SeedUncertainty& uncertainty) {
  Vector6d offset;
  for (int i = 0; i < 3; ++i) {
    offset[i] = random.uniform(-1.0, 1.0) * uncertainty.rotation_rad[i];
    offset[3 + i] = random.uniform(-1.0, 1.0) * uncertainty.translation_m[i];
  }
  return offset;
}

/// A prepared camera; the coefficients in the model's order, the rest zero. The principal point is
/// the image centre.
inline Camera makeCamera(CameraModel model, int width, int height, double focal_length_px,
                         std::initializer_list<double> distortion = {}) {
  Camera camera;
  camera.model = model;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_length_px;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  std::size_t i = 0;
  for (const double coefficient : distortion) camera.distortion.at(i++) = coefficient;
  if (prepareCamera(camera) != Status::kOk) camera.valid_radius = 0.0;
  return camera;
}

inline Camera makePinhole(int width, int height, double focal_length_px) {
  return makeCamera(CameraModel::kPinhole, width, height, focal_length_px);
}

/// A camera with pixels not quite square, the principal point off centre, and mild distortion that
/// is invertible over the whole image.
inline Camera randomCamera(Random& random, CameraModel model) {
  Camera camera;
  camera.model = model;
  camera.width = 320 + static_cast<int>(random.below(2000));
  camera.height = 240 + static_cast<int>(random.below(2000));
  const double larger = camera.width > camera.height ? camera.width : camera.height;
  camera.fx = larger * random.uniform(0.9, 2.5);
  camera.fy = camera.fx * random.uniform(0.95, 1.05);
  camera.cx = camera.width * random.uniform(0.4, 0.6);
  camera.cy = camera.height * random.uniform(0.4, 0.6);
  auto& k = camera.distortion;
  if (model == CameraModel::kBrownConrady) {
    k = {random.uniform(-0.1, 0.1),   random.uniform(-0.05, 0.05), random.uniform(-2e-3, 2e-3),
         random.uniform(-2e-3, 2e-3), random.uniform(0.0, 0.02),   random.uniform(-0.05, 0.05),
         random.uniform(-0.02, 0.02), random.uniform(0.0, 0.01)};
  } else if (model == CameraModel::kKannalaBrandt) {
    k = {random.uniform(-0.05, 0.05), random.uniform(-0.02, 0.02), random.uniform(-0.01, 0.01),
         random.uniform(0.0, 0.003)};
  } else if (isCahvFamily(model)) {
    camera.cahv.skew_px = camera.fx * random.uniform(-0.02, 0.02);
    const double off_x = random.uniform(-0.01, 0.01);
    const double off_y = random.uniform(-0.01, 0.01);
    if (model != CameraModel::kCahv) {
      camera.cahv.optical_axis = Eigen::Vector3d(off_x, off_y, 1.0).normalized();
      camera.cahv.radial = randomVector(random, 0.02);
    }
    if (model == CameraModel::kCahvore) {
      camera.cahv.entrance_m = randomVector(random, 0.01);
      camera.cahv.linearity = random.uniform(-0.6, 1.0);
    }
  }
  if (prepareCamera(camera) != Status::kOk) camera.valid_radius = 0.0;
  return camera;
}

/// Matches a pose whose rotation differs by at most `rotation_rad` and whose translation by at most
/// `translation_m`; a failure prints both poses and both differences.
MATCHER_P3(poseNear, expected, rotation_rad, translation_m,
           "within " + ::testing::PrintToString(rotation_rad) + " rad and " +
               ::testing::PrintToString(translation_m) + " m of " +
               ::testing::PrintToString(expected)) {
  const Pose& actual = arg;
  const Pose& wanted = expected;
  const Eigen::Quaterniond turn = actual.rotation * wanted.rotation.conjugate();
  const double angle_rad = rotationLog(turn).norm();
  const double distance_m = (actual.translation_m - wanted.translation_m).norm();
  *result_listener << "which differs by " << angle_rad << " rad and " << distance_m << " m";
  return angle_rad <= rotation_rad && distance_m <= translation_m;
}

}  // namespace test
}  // namespace boresight
