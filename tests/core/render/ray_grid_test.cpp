// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"
#include "tests/support/not_finite.h"

namespace boresight::testing {
namespace {

/// A grid whose memory is used again by the next one.
RayGrid gridOf(const Camera& camera) {
  static std::vector<std::byte> memory(std::size_t{8} << 20);
  Arena arena(memory);
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
  return grid;
}

TEST(RayGrid, Rays_AreThoseOfTheCamera) {
  const struct {
    Camera camera;
    double most_ray;       ///< difference of (x/z, y/z)
    double most_pixel_px;  ///< distance after projecting back
  } cases[] = {{pinholeCamera(333, 257, 300.0), 1e-15, test::kInfinity},
               {brownCamera(2048, 1024, 3100.0, -0.12), 1e-9, test::kInfinity},
               {brownCamera(1024, 777, 900.0, -0.28), 3e-8, test::kInfinity},
               {fisheyeCamera(1000, 800, 330.0), test::kInfinity, 3e-5},
               // Pixels outside the valid field are marked.
               {brownCamera(400, 300, 180.0, -0.35), test::kInfinity, 3e-5}};
  for (const auto& [camera, most_ray, most_pixel_px] : cases) {
    SCOPED_TRACE(camera.fx);
    const RayGrid grid = gridOf(camera);
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
        const Eigen::Vector2d at(begin + i, row);
        Eigen::Vector3d ray;
        Eigen::Vector2d pixel;
        ASSERT_EQ(unproject(camera, at, ray), valid[k] != 0) << at.transpose();
        if (valid[k] == 0) continue;
        EXPECT_LT(std::max(std::abs(x[k] - ray.x()), std::abs(y[k] - ray.y())), most_ray);
        EXPECT_TRUE(project(camera, Eigen::Vector3d(x[k], y[k], 1.0), pixel));
        EXPECT_LT((pixel - at).norm(), most_pixel_px);
      }
    }
  }
}

TEST(RayGrid, UsesExactlyTheCountedBytes) {
  const Camera camera = brownCamera(400, 300, 380.0, -0.1);
  Arena counting;
  RayGrid grid;
  EXPECT_EQ(RayGrid::create(Camera(), counting, grid), Status::kInvalidCamera);
  EXPECT_EQ(RayGrid::create(camera, counting, grid), Status::kOk);
  std::vector<std::byte> memory(counting.used());
  Arena arena(memory);
  EXPECT_EQ(RayGrid::create(camera, arena, grid), Status::kOk);
  Arena small(std::span<std::byte>(memory).first(1000));
  EXPECT_EQ(RayGrid::create(camera, small, grid), Status::kArenaTooSmall);
}

/// Equidistant fisheye.
Camera equidistantCamera(int size, double focal_px) {
  return fisheyeCamera(size, size, focal_px, {});
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
    const RayGrid grid = gridOf(camera);
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
    const RayGrid grid = gridOf(equidistantCamera(512, focal_px));
    EXPECT_LT(grid.lineBend_per_px(), 3.0 / focal_px) << focal_px;
    EXPECT_GT(grid.lineBend_per_px(), 0.3 / focal_px) << focal_px;
  }
}

TEST(RayGrid, RangesHoldEveryPixelAndNotAllBeyondNinetyDegrees) {
  const Camera camera = equidistantCamera(512, 220.0);  // without rays in the corners
  const RayGrid grid = gridOf(camera);
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
