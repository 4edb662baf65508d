// SPDX-License-Identifier: Apache-2.0
// An example's picture as a mission would send it: taken by a CAHVOR camera that its label tells
// of.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_case.h"
#include "tests/support/vicar_image.h"

namespace boresight::test {

/// A CAHVOR camera that sees about what the example's does, its optical axis off A.
inline Camera labelCamera() {
  Camera camera;
  camera.model = CameraModel::kCahvor;
  camera.width = camera.height = 1024;
  camera.fx = camera.fy = 1560.0;
  camera.cx = 511.0;
  camera.cy = 512.5;
  camera.cahv.optical_axis = Eigen::Vector3d(0.002, -0.001, 1.0).normalized();
  camera.cahv.radial = {1e-5, -0.08, 0.03};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// The example's picture as that camera would have taken it: 12 bits, by bilinear interpolation.
inline std::vector<std::uint16_t> seenBy(const Camera& camera, const ExampleCase& example) {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      Eigen::Vector2d p(-1.0, -1.0);
      const bool seen = unproject(camera, {x, y}, ray) && projectDirection(example.camera, ray, p);
      const int x0 = static_cast<int>(std::floor(p.x())), y0 = static_cast<int>(std::floor(p.y()));
      if (!seen || x0 < 0 || y0 < 0 || x0 + 1 >= example.image.width ||
          y0 + 1 >= example.image.height) {
        samples.push_back(0);
        continue;
      }
      const auto gray = [&](int dx, int dy) -> double {
        return example.image
            .pixels[static_cast<std::size_t>((y0 + dy) * example.image.width + x0 + dx)];
      };
      const double fx = p.x() - x0, fy = p.y() - y0;
      const double value = (1 - fy) * ((1 - fx) * gray(0, 0) + fx * gray(1, 0)) +
                           fy * ((1 - fx) * gray(0, 1) + fx * gray(1, 1));
      samples.push_back(static_cast<std::uint16_t>(std::lround(value * 4095.0 / 255.0)));
    }
  return samples;
}

/// Its file, the camera's vectors in the rover's frame; `groups` follow those of image and camera.
inline std::vector<std::uint8_t> downlinkImage(const ExampleCase& example,
                                               const Pose& rover_from_camera,
                                               const sessions::FrameName& rover,
                                               const std::string& groups = {}) {
  const Camera camera = labelCamera();
  const CahvModel cahv = cahvFromCamera(camera, rover_from_camera.inverse());
  return vicarImage(camera.width, camera.height, seenBy(camera, example),
                    "PROPERTY='IMAGE_DATA'  SAMPLE_BIT_MASK='2#0000111111111111#'  "
                    "PROPERTY='IDENTIFICATION'  INSTRUMENT_ID='FRONT_HAZCAM_LEFT'  "
                    "PRODUCT_ID='1F483288473'  " +
                        vicarCamera(cahv, rover) + groups);
}

}  // namespace boresight::test
