// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/localizer/problem.h"
#include "sessions/io/images/image_file.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {

/// Pictures of a camera that approaches the station of tests/core/localizer/scene.h, with exact
/// poses; those who use it compile tests/core/localizer/scene.cpp. From 0.53 m to 0.43 m, turning
/// by 9 deg and sliding by 15 mm: with 24 frames 4.4 mm and 0.4 deg from one to the next.
class GeneratedApproach {
 public:
  explicit GeneratedApproach(int frames) : frames_(frames) {}

  const Solid& solid() const { return solid_; }
  const Camera& camera() const { return camera_; }
  int frames() const { return frames_; }

  Pose camera_from_station(int frame) const {
    const double way = static_cast<double>(frame) / std::max(1, frames_ - 1);
    Pose pose = truthPose();
    pose.rotation =
        (rotationExp({0.10 * way, -0.08 * way, 0.09 * way}) * pose.rotation).normalized();
    pose.translation_m = {0.012 - 0.015 * way, -0.006 + 0.004 * way, 0.53 - 0.10 * way};
    return pose;
  }

  sessions::GrayImage image(int frame) const {
    return imageOf(takePicture(solid_, camera_, camera_from_station(frame)));
  }
  /// Nothing but noise.
  sessions::GrayImage coveredImage() const {
    return imageOf(noisePicture(camera_.width, camera_.height, 7));
  }

 private:
  static sessions::GrayImage imageOf(const Picture& picture) {
    sessions::GrayImage image;
    image.width = picture.width;
    image.height = picture.height;
    image.pixels = picture.gray;
    return image;
  }

  int frames_;
  Solid solid_ = stationMesh();
  Camera camera_ = pinholeCamera();
};

}  // namespace boresight::test
