// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/undistort.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// A picture whose gray value says where the ray through a pixel goes: smooth, so that bilinear
/// interpolation is good to a gray level.
double shade(double x_over_z, double y_over_z) {
  return 128.0 + 60.0 * std::sin(9.0 * x_over_z) + 50.0 * std::cos(7.0 * y_over_z);
}

std::vector<std::uint8_t> pictureOf(const Camera& camera) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      const bool seen = unproject(camera, Eigen::Vector2d(x, y), ray);
      pixels.push_back(seen ? static_cast<std::uint8_t>(std::lround(shade(ray.x(), ray.y()))) : 0);
    }
  return pixels;
}

void expectStraight(const Camera& camera) {
  const std::vector<std::uint8_t> pixels = pictureOf(camera);
  const UndistortedImage straight =
      undistort(camera, {pixels.data(), camera.width, camera.height, camera.width});
  ASSERT_EQ(straight.camera.model, CameraModel::kPinhole);
  int compared = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      ASSERT_TRUE(unproject(straight.camera, Eigen::Vector2d(x, y), ray));
      Eigen::Vector2d place;
      const bool seen = project(camera, ray, place) && place.x() >= 0.0 && place.y() >= 0.0 &&
                        place.x() <= camera.width - 1 && place.y() <= camera.height - 1;
      if (!seen) continue;
      ++compared;
      EXPECT_NEAR(straight.view().at(x, y), shade(ray.x(), ray.y()), 1.6);
    }
  EXPECT_GT(compared, camera.width * camera.height / 2);
}

TEST(Undistort, PutsEveryRayWhereAPinholeSeesItAndLeavesAPinholeImageAsItIs) {
  expectStraight(
      test::makeCamera(CameraModel::kBrownConrady, 200, 160, 210.0, {-0.2, 0.05, 1e-3, -2e-3}));
  expectStraight(test::makeCamera(CameraModel::kKannalaBrandt, 200, 160, 150.0, {0.02, -0.01}));
  const Camera camera = test::makePinhole(64, 48, 80.0);
  const std::vector<std::uint8_t> pixels = pictureOf(camera);
  EXPECT_EQ(undistort(camera, {pixels.data(), 64, 48, 64}).pixels, pixels);
}

TEST(Undistort, IsBlackWhereTheCameraDoesNotSee) {
  const Camera camera =
      test::makeCamera(CameraModel::kBrownConrady, 200, 160, 210.0, {0.3, 0.0, 0.0, 0.0});
  const std::vector<std::uint8_t> white(200 * 160, 255);
  const UndistortedImage straight = undistort(camera, {white.data(), 200, 160, 200});
  // Its pixels lie further out than the pinhole's, whose corner therefore lies outside its image.
  EXPECT_EQ(straight.view().at(0, 0), 0);
  EXPECT_EQ(straight.view().at(100, 80), 255);
}

}  // namespace
}  // namespace boresight::sessions
