// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/cahv_model.h"

#include <cmath>

namespace boresight {
namespace {

/// Labels are rounded to six digits or so.
constexpr double kUnitTolerance = 1e-3;

bool isUnit(double length) {
  return length > 1.0 - kUnitTolerance && length < 1.0 + kUnitTolerance;
}

double lengthOf(const Eigen::Vector3d& vector) { return std::sqrt(vector.squaredNorm()); }

bool setLinearity(const CahvModel& cahv, double& linearity) {
  if (cahv.model != CameraModel::kCahvore) return true;
  linearity = cahv.type == 1 ? 1.0 : cahv.type == 2 ? 0.0 : cahv.parameter;
  return cahv.type >= 1 && cahv.type <= 3;
}

}  // namespace

Status cameraFromCahv(const CahvModel& cahv, int width, int height, Camera& camera,
                      Pose& camera_from_reference) {
  camera = Camera();
  camera.model = cahv.model;
  camera.width = width;
  camera.height = height;
  const double axis_length = lengthOf(cahv.a);
  if (!isCahvFamily(cahv.model) || !isUnit(axis_length) ||
      !setLinearity(cahv, camera.cahv.linearity))
    return Status::kInvalidCamera;
  const Eigen::Vector3d z = cahv.a / axis_length;
  const Eigen::Vector3d h = cahv.h_px / axis_length;
  const Eigen::Vector3d v = cahv.v_px / axis_length;
  camera.cx = z.dot(h);
  const Eigen::Vector3d across = h - camera.cx * z;
  camera.fx = lengthOf(across);
  if (!(camera.fx > 0.0)) return Status::kInvalidCamera;
  const Eigen::Vector3d x = across / camera.fx;
  const Eigen::Vector3d y = z.cross(x);
  camera.cahv.skew_px = v.dot(x);
  camera.fy = v.dot(y);
  camera.cy = v.dot(z);

  Eigen::Matrix3d rotation;
  rotation.row(0) = x.transpose();
  rotation.row(1) = y.transpose();
  rotation.row(2) = z.transpose();
  double deviation = 0.0;
  const Status status =
      poseFromMatrix(rotation, rotation * -cahv.c_m, camera_from_reference, deviation);
  if (status != Status::kOk) return Status::kInvalidCamera;
  if (cahv.model != CameraModel::kCahv) {
    const double optical_length = lengthOf(cahv.o);
    if (!isUnit(optical_length)) return Status::kInvalidCamera;
    // A vector of length 1 but for rounding is kept, so that a camera is read as written.
    const Eigen::Vector3d optical = rotation * cahv.o;
    const double excess = lengthOf(optical) - 1.0;
    camera.cahv.optical_axis =
        excess < 1e-15 && excess > -1e-15 ? optical : Eigen::Vector3d(optical / lengthOf(optical));
    camera.cahv.radial = cahv.r;
  }
  if (cahv.model == CameraModel::kCahvore) camera.cahv.entrance_m = cahv.e_m;
  return prepareCamera(camera);
}

CahvModel cahvFromCamera(const Camera& camera, const Pose& camera_from_reference) {
  const Eigen::Matrix3d reference_from_camera = camera_from_reference.matrix().transpose();
  CahvModel cahv;
  cahv.model = camera.model;
  // 0 rather than -0 where there is nothing to subtract.
  cahv.c_m = Eigen::Vector3d::Zero() - reference_from_camera * camera_from_reference.translation_m;
  cahv.a = reference_from_camera.col(2);
  cahv.h_px = reference_from_camera * Eigen::Vector3d(camera.fx, 0.0, camera.cx);
  cahv.v_px = reference_from_camera * Eigen::Vector3d(camera.cahv.skew_px, camera.fy, camera.cy);
  cahv.o = reference_from_camera * camera.cahv.optical_axis;
  cahv.r = camera.cahv.radial;
  cahv.e_m = camera.cahv.entrance_m;
  cahv.parameter = camera.cahv.linearity;
  cahv.type = cahv.parameter == 1.0 ? 1 : cahv.parameter == 0.0 ? 2 : 3;
  return cahv;
}

}  // namespace boresight
