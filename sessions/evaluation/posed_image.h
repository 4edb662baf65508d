// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// What other programs' formats know of a solved image.
struct PosedImage {
  int id = 0;        ///< of the image, not negative
  std::string name;  ///< its file; where the format has one
  Camera camera;     ///< after prepareCamera
  Pose camera_from_station;
  /// Review status of the pose for formats with remarks. One line.
  std::string remark = {};
};

}  // namespace boresight::sessions
