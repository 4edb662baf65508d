// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

struct Deviation {
  double ray = 0.0;       ///< largest difference of (x/z, y/z)
  double pixel_px = 0.0;  ///< largest distance after projecting back
  int disagreements = 0;  ///< pixels valid in one way and not in the other
};

Deviation deviationOf(const Camera& camera) {
  std::vector<std::byte> memory(std::size_t{8} << 20);
  Arena arena(memory);
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
  Deviation worst;
  const auto width = static_cast<std::size_t>(camera.width);
  std::vector<double> x(width), y(width);
  std::vector<std::uint8_t> valid(width);
  for (int row = 0; row < camera.height; row += 3) {
    // Pieces of rows, beginning anywhere.
    const int begin = (row * 7) % 50;
    const int count = camera.width - begin - (row * 5) % 31;
    grid.row(row, begin, count, x.data(), y.data(), valid.data());
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      Eigen::Vector3d ray;
      const bool ok = unproject(camera, Eigen::Vector2d(begin + i, row), ray);
      if (ok != (valid[k] != 0)) ++worst.disagreements;
      if (!ok || valid[k] == 0) continue;
      worst.ray = std::max({worst.ray, std::abs(x[k] - ray.x()), std::abs(y[k] - ray.y())});
      Eigen::Vector2d pixel;
      EXPECT_TRUE(project(camera, Eigen::Vector3d(x[k], y[k], 1.0), pixel));
      worst.pixel_px = std::max(worst.pixel_px, (pixel - Eigen::Vector2d(begin + i, row)).norm());
    }
  }
  return worst;
}

TEST(RayGrid, PinholeIsExact) { EXPECT_LT(deviationOf(pinholeCamera(333, 257, 300.0)).ray, 1e-15); }

TEST(RayGrid, MildDistortionWithinABillionth) {
  Camera camera = brownCamera(2048, 1024, 3100.0, -0.12);
  EXPECT_LT(deviationOf(camera).ray, 1e-9);
  EXPECT_EQ(deviationOf(camera).disagreements, 0);
  EXPECT_LT(deviationOf(brownCamera(1024, 777, 900.0, -0.28)).ray, 3e-8);
}

TEST(RayGrid, WideFieldsWithinAHundredThousandthOfAPixel) {
  const Deviation worst = deviationOf(fisheyeCamera(1000, 800, 330.0));
  EXPECT_LT(worst.pixel_px, 3e-5);
  EXPECT_EQ(worst.disagreements, 0);
}

TEST(RayGrid, PixelsOutsideTheValidFieldAreMarked) {
  Camera camera = brownCamera(400, 300, 180.0, -0.35);
  const Deviation worst = deviationOf(camera);
  EXPECT_EQ(worst.disagreements, 0);
  EXPECT_LT(worst.pixel_px, 3e-5);
}

TEST(RayGrid, RefusesNonsense) {
  Arena arena;
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(Camera(), arena, grid), Status::kInvalidCamera);
  Camera camera = brownCamera(400, 300, 180.0, -0.1);
  std::vector<std::byte> memory(1000);
  Arena small(memory);
  EXPECT_EQ(RayGrid::create(camera, small, grid), Status::kArenaTooSmall);
}

TEST(RayGrid, CountsWhatItUses) {
  const Camera camera = brownCamera(400, 300, 380.0, -0.1);
  Arena counting;
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(camera, counting, grid), Status::kOk);
  std::vector<std::byte> memory(counting.used());
  Arena arena(memory);
  EXPECT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
}

}  // namespace
}  // namespace boresight::testing
