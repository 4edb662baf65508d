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
  for (int i = 0; i < count; ++i)
    images.push_back({3 * i + 1, "folder/image " + std::to_string(i) + ".png",
                      cameras[static_cast<std::size_t>(i) % cameras.size()], randomPose(random)});
  return images;
}

/// Its pixels are not quite square, its principal point is off the centre.
inline Camera preparedCamera(CameraModel model, std::initializer_list<double> distortion = {}) {
  Camera camera = makeCamera(model, 640, 480, 700.25, distortion);
  camera.fy = 701.125;
  camera.cx = 319.375;
  camera.cy = 241.1;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

}  // namespace boresight::test
