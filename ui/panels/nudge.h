// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/pose.h"

namespace boresight::ui {

/// Along and about whose axes a pose is nudged.
enum class NudgeAxes { kCamera, kStation };
/// What stays where it is while the pose is turned.
enum class NudgePivot { kStationCentre, kCameraCentre };

/// How nudges are meant; `centre_in_station_m` is the centre of the matched parts.
struct NudgeFrame {
  NudgeAxes axes = NudgeAxes::kCamera;
  NudgePivot pivot = NudgePivot::kStationCentre;
  Eigen::Vector3d centre_in_station_m = Eigen::Vector3d::Zero();
};

/// A pose displaced by (rotation vector rad, translation m): the station is turned about the pivot,
/// then moved, along the camera's axes or its own. Seen from the camera the station moves that way,
/// whichever of the two really does. The station's axes and the pivot are those of the given pose.
Pose nudged(const Pose& camera_from_station, const Vector6d& offset, const NudgeFrame& frame);

/// The offset that `nudged` would need to get from the first pose to the second.
Vector6d nudgeBetween(const Pose& camera_from_station_base, const Pose& camera_from_station,
                      const NudgeFrame& frame);

}  // namespace boresight::ui
