// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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

TEST(RayGrid, UnpreparedCameraOrSmallArena_IsRefused) {
  Arena arena;
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(Camera(), arena, grid), Status::kInvalidCamera);
  Camera camera = brownCamera(400, 300, 180.0, -0.1);
  std::vector<std::byte> memory(1000);
  Arena small(memory);
  EXPECT_EQ(RayGrid::create(camera, small, grid), Status::kArenaTooSmall);
}

TEST(RayGrid, UsesExactlyTheCountedBytes) {
  const Camera camera = brownCamera(400, 300, 380.0, -0.1);
  Arena counting;
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(camera, counting, grid), Status::kOk);
  std::vector<std::byte> memory(counting.used());
  Arena arena(memory);
  EXPECT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
}

/// Equidistant fisheye.
Camera equidistantCamera(int size, double focal_px) {
  Camera camera = fisheyeCamera(size, size, focal_px);
  camera.distortion = {};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// How far the image of the straight line between two pixels' rays is from their chord, px.
double bulge(const Camera& camera, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Eigen::Vector3d from, to;
  if (!unproject(camera, a, from) || !unproject(camera, b, to)) return 0.0;
  const Eigen::Vector2d along = (b - a).normalized();
  double largest = 0.0;
  for (int i = 1; i < 64; ++i) {
    Eigen::Vector2d pixel;
    // Even steps of angle, not of (x/z, y/z), which has its pole near by.
    const Eigen::Vector3d between =
        from.normalized() * (64 - i) / 64.0 + to.normalized() * i / 64.0;
    if (!projectDirection(camera, between, pixel)) continue;
    const Eigen::Vector2d off = pixel - a;
    largest = std::max(largest, std::abs(along.x() * off.y() - along.y() * off.x()));
  }
  return largest;
}

TEST(RayGrid, LinesBendByNoMoreThanItsBound) {
  const Camera cameras[] = {
      brownCamera(640, 480, 700.0, -0.28), brownCamera(400, 300, 180.0, -0.35),
      fisheyeCamera(500, 400, 165.0),      equidistantCamera(512, 220.0),
      equidistantCamera(512, 227.0),       equidistantCamera(512, 300.0),
      skewMirroredCamera(500, 400, 400.0), pupilCamera(512, 384, 230.0, 0.01)};
  Random random(17);
  for (const Camera& camera : cameras) {
    std::vector<std::byte> memory(std::size_t{8} << 20);
    Arena arena(memory);
    RayGrid grid;
    ASSERT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector2d a(random.uniform() * camera.width, random.uniform() * camera.height);
      const double length_px = random.uniform(2.0, 40.0);
      const double angle_rad = 6.2832 * random.uniform();
      const Eigen::Vector2d b =
          a + length_px * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
      if (b.minCoeff() < 0.0 || b.x() > camera.width || b.y() > camera.height) continue;
      ASSERT_LE(bulge(camera, a, b), 0.125 * grid.lineBend_per_px() * length_px * length_px + 1e-6)
          << camera.fx << ": " << a.transpose() << " to " << b.transpose();
    }
  }
}

/// The great circles that an equidistant camera shows bend by less than 1 / f wherever they are.
TEST(RayGrid, ItsBoundOnBendsIsNoLargerAtNinetyDegrees) {
  for (const double focal_px : {200.0, 220.0, 227.0, 240.0, 260.0, 400.0}) {
    std::vector<std::byte> memory(std::size_t{8} << 20);
    Arena arena(memory);
    RayGrid grid;
    ASSERT_EQ(RayGrid::create(equidistantCamera(512, focal_px), arena, grid), Status::kOk);
    EXPECT_LT(grid.lineBend_per_px(), 3.0 / focal_px) << focal_px;
    EXPECT_GT(grid.lineBend_per_px(), 0.3 / focal_px) << focal_px;
  }
}

TEST(RayGrid, RangesHoldEveryPixelAndNotAllBeyondNinetyDegrees) {
  const Camera camera = equidistantCamera(512, 220.0);  // without rays in the corners
  std::vector<std::byte> memory(std::size_t{8} << 20);
  Arena arena(memory);
  RayGrid grid;
  ASSERT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
  ASSERT_FALSE(grid.smooth());
  Random random(18);
  for (int i = 0; i < 200; ++i) {
    const double low = 12.0 * random.uniform() - 6.0;
    const double high = low + 2.0 * random.uniform();
    const RayGrid::Range rows = grid.rowsWithin(low, high);
    const RayGrid::Range columns = grid.columnsWithin(low, high);
    for (int k = 0; k < 500; ++k) {
      const Eigen::Vector2d pixel(std::floor(random.uniform() * camera.width),
                                  std::floor(random.uniform() * camera.height));
      Eigen::Vector3d ray;
      if (!unproject(camera, pixel, ray)) continue;
      const bool row_held = pixel.y() >= rows.first && pixel.y() <= rows.last;
      const bool column_held = pixel.x() >= columns.first && pixel.x() <= columns.last;
      EXPECT_TRUE(row_held || !(ray.y() >= low && ray.y() <= high)) << low << " " << pixel.y();
      EXPECT_TRUE(column_held || !(ray.x() >= low && ray.x() <= high)) << low << " " << pixel.x();
    }
  }
  // Above the middle y/z is negative, also at the border of the field.
  EXPECT_GT(grid.rowsWithin(0.1, 0.2).first, 200);
  EXPECT_LT(grid.rowsWithin(0.1, 0.2).last, 320);
  EXPECT_GT(grid.columnsWithin(3.0, 5.0).first, 300);
}

}  // namespace
}  // namespace boresight::testing
