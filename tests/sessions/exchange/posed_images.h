// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/evaluation/posed_image.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

/// Images of three cameras, every other one of the first.
inline std::vector<sessions::PosedImage> randomImages(Random& random,
                                                      const std::vector<Camera>& cameras,
                                                      int count) {
  std::vector<sessions::PosedImage> images;
  for (int i = 0; i < count; ++i) {
    sessions::PosedImage image;
    image.id = 3 * i + 1;
    image.name = "folder/image " + std::to_string(i) + ".png";
    image.camera = cameras[static_cast<std::size_t>(i) % cameras.size()];
    image.camera_from_station = randomPose(random);
    images.push_back(image);
  }
  return images;
}

inline Camera preparedCamera(CameraModel model, std::initializer_list<double> distortion) {
  Camera camera;
  camera.model = model;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 700.25;
  camera.fy = 701.125;
  camera.cx = 319.375;
  camera.cy = 241.1;
  std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

}  // namespace boresight::test
