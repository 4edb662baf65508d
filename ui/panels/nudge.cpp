// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/nudge.h"

namespace boresight::ui {
namespace {

Eigen::Vector3d pivotInCamera_m(const Pose& camera_from_station, const NudgeFrame& frame) {
  if (frame.pivot == NudgePivot::kCameraCentre) return Eigen::Vector3d::Zero();
  return camera_from_station * frame.centre_in_station_m;
}

/// Turns both halves of an offset by a rotation: rotation vectors turn as vectors do.
Vector6d turned(const Eigen::Quaterniond& rotation, const Vector6d& offset) {
  Vector6d result;
  result.head<3>() = rotation * offset.head<3>();
  result.tail<3>() = rotation * offset.tail<3>();
  return result;
}

}  // namespace

Pose nudged(const Pose& camera_from_station, const Vector6d& offset, const NudgeFrame& frame) {
  const bool own = frame.axes == NudgeAxes::kStation;
  return displacedAboutPivot(camera_from_station,
                             own ? turned(camera_from_station.rotation, offset) : offset,
                             pivotInCamera_m(camera_from_station, frame));
}

Vector6d nudgeBetween(const Pose& camera_from_station_base, const Pose& camera_from_station,
                      const NudgeFrame& frame) {
  const Vector6d offset = offsetAboutPivot(camera_from_station_base, camera_from_station,
                                           pivotInCamera_m(camera_from_station_base, frame));
  const bool own = frame.axes == NudgeAxes::kStation;
  return own ? turned(camera_from_station_base.rotation.conjugate(), offset) : offset;
}

}  // namespace boresight::ui
