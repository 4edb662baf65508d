// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// A point of the station and its image position.
struct SeenPoint {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// A solved image as other programs' formats describe it.
struct PosedImage {
  int id = 0;        ///< of the image, not negative
  std::string name;  ///< file name, where the format has one
  Camera camera;     ///< after prepareCamera
  Pose camera_from_station;
  /// Review status of the pose for formats with remarks. One line.
  std::string remark = {};
  std::vector<SeenPoint> points = {};  ///< annotated ones, for formats with points
};

}  // namespace boresight::sessions
