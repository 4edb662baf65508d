// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/camera.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

struct NamedCamera {
  std::string name;
  Camera camera;
};

inline void PrintTo(const NamedCamera& named, std::ostream* out) { *out << named.name; }

/// Pixel of a point; the test fails when it does not project.
inline Eigen::Vector2d pixelOf(const Camera& camera, const Eigen::Vector3d& point) {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  EXPECT_TRUE(project(camera, point, pixel)) << point.transpose();
  return pixel;
}

/// Anywhere in the image.
inline Eigen::Vector2d randomPixel(const Camera& camera, Random& random) {
  const double x = random.uniform(-1.0, camera.width);
  const double y = random.uniform(-1.0, camera.height);
  return {x, y};
}

/// The ray of a pixel; the test fails when there is none.
inline Ray rayOf(const Camera& camera, const Eigen::Vector2d& pixel) {
  Ray ray;
  EXPECT_TRUE(unprojectRay(camera, pixel, ray)) << pixel.transpose();
  return ray;
}

/// The derivatives of a projection by its point against central differences.
inline void expectDerivatives(const Camera& camera, const Eigen::Vector3d& point,
                              const Eigen::Matrix<double, 2, 3>& jacobian, double step,
                              double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d shift = step * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d ahead = pixelOf(camera, point + shift);
    const Eigen::Vector2d behind = pixelOf(camera, point - shift);
    EXPECT_LT(((ahead - behind) / (2.0 * step) - jacobian.col(axis)).norm(), tolerance)
        << point.transpose();
  }
}

inline Camera shifted(Camera camera, double cx, double cy, double aspect) {
  camera.cx += cx;
  camera.cy += cy;
  camera.fy = camera.fx * aspect;
  if (prepareCamera(camera) != Status::kOk) camera.valid_radius = 0.0;
  return camera;
}

/// Cameras whose whole image is inside the valid field.
inline std::vector<NamedCamera> exampleCameras() {
  using enum CameraModel;
  return {
      {"Pinhole", shifted(makePinhole(2048, 1500, 3100.0), 20.3, -12.7, 1.01)},
      {"PlanetaryTelephoto",
       shifted(makeCamera(kBrownConrady, 2048, 2048, 3105.0, {-0.12, 0.06, 0.0004, -0.0003, 0.0}),
               5.2, -7.1, 0.999)},
      {"Industrial", makeCamera(kBrownConrady, 2448, 2048, 2337.0, {-0.086, 0.133, 0.0, 0.0, 0.0})},
      {"PhoneLike",
       shifted(makeCamera(kBrownConrady, 640, 480, 1045.0, {-0.0027, 0.209, 0.0011, -0.0066, 0.0}),
               -8.0, 9.5, 1.002)},
      {"StrongBarrelRational",
       shifted(makeCamera(kBrownConrady, 1280, 960, 620.0,
                          {0.35, 0.08, 0.0008, -0.0005, 0.004, 0.72, 0.21, 0.02}),
               3.0, 4.0, 1.0)},
      {"BarrelFiveTerms",
       makeCamera(kBrownConrady, 1920, 1080, 1300.0, {-0.28, 0.10, 0.001, -0.0007, -0.018})},
      {"Pincushion", makeCamera(kBrownConrady, 800, 600, 700.0, {0.25, 0.1, -0.002, 0.003, 0.05})},
      {"Fisheye",
       shifted(makeCamera(kKannalaBrandt, 1280, 1024, 600.0, {-0.012, 0.006, -0.0045, 0.0008}), 6.0,
               -3.0, 1.003)},
      {"FisheyeMild", makeCamera(kKannalaBrandt, 2048, 2048, 1800.0, {0.08, -0.03, 0.01, -0.002})},
  };
}

}  // namespace boresight::test
