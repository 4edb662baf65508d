// SPDX-License-Identifier: Apache-2.0
#include "core/refine/weak_directions.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace boresight {
namespace {

constexpr double kFocal_px = 1000.0;

Camera camera() {
  Camera camera;
  camera.width = camera.height = 1024;
  camera.fx = camera.fy = kFocal_px;
  camera.cx = camera.cy = 511.5;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// Edge places in front of the camera, with the station's frame in the camera's.
struct Places {
  std::vector<EdgeSample> samples;

  void add(const Eigen::Vector3d& point_m, double normal_x, double normal_y) {
    EdgeSample sample;
    sample.point_in_station_m = point_m;
    sample.normal_x = static_cast<std::int8_t>(std::lround(127.0 * normal_x));
    sample.normal_y = static_cast<std::int8_t>(std::lround(127.0 * normal_y));
    samples.push_back(sample);
  }
  RefinementResult result() {
    RefinementResult result;
    result.samples = samples;
    result.sample_count = static_cast<std::int32_t>(samples.size());
    return result;
  }
};

/// Root mean square of the places' motion when the pose moves: of all of it, and along the normals.
struct Motion {
  double all_px = 0.0;
  double normal_px = 0.0;
};

Motion motionOf(const Places& places, const Pose& moved) {
  Motion motion;
  for (const EdgeSample& sample : places.samples) {
    Eigen::Vector2d before;
    Eigen::Vector2d after;
    EXPECT_TRUE(project(camera(), sample.point_in_station_m, before));
    EXPECT_TRUE(project(camera(), moved * sample.point_in_station_m, after));
    motion.all_px += (after - before).squaredNorm();
    motion.normal_px += std::pow(sample.normal().dot(after - before), 2);
  }
  const auto count = static_cast<double>(places.samples.size());
  return {std::sqrt(motion.all_px / count), std::sqrt(motion.normal_px / count)};
}

TEST(WeakDirections, LongBar_IsWeakAlongItself) {
  Places places;
  for (int i = -50; i <= 50; ++i) {
    places.add({0.002 * i, 0.01, 0.5}, 0.0, 1.0);
    places.add({0.002 * i, -0.01, 0.5}, 0.0, -1.0);
  }
  const WeakDirections weak = weakDirections(places.result(), camera(), {0.0, 0.0, 0.5});
  ASSERT_TRUE(weak.known);
  EXPECT_LT(weak.seen[0], 1e-6);
  for (const double motion_px : {-3.0, 5.0}) {
    const Pose moved = weak.moved(Pose(), 0, motion_px);
    const Motion motion = motionOf(places, moved);
    EXPECT_NEAR(motion.all_px, std::abs(motion_px), 0.05);
    EXPECT_LT(motion.normal_px, 0.1);
    EXPECT_NEAR(std::abs(moved.translation_m.x()), std::abs(motion_px) * 0.5 / kFocal_px, 2e-4);
  }
}

TEST(WeakDirections, NoOtherDirection_IsWeaker) {
  Random random(3);
  Places places;
  for (int i = 0; i < 300; ++i) {
    const double angle_rad = random.uniform(0.0, 6.283);
    places.add({random.uniform(-0.05, 0.05), random.uniform(-0.03, 0.03), random.uniform(0.4, 0.5)},
               std::cos(angle_rad), std::sin(angle_rad));
  }
  const WeakDirections weak = weakDirections(places.result(), camera(), {0.0, 0.0, 0.45});
  ASSERT_TRUE(weak.known);
  EXPECT_LE(weak.seen[0], weak.seen[1]);
  for (int k = 0; k < 2; ++k) {
    const Motion motion = motionOf(places, weak.moved(Pose(), k, 0.01));
    EXPECT_NEAR(motion.all_px, 0.01, 1e-4);
    EXPECT_NEAR(motion.normal_px / motion.all_px, weak.seen[static_cast<std::size_t>(k)], 0.01);
  }
  for (int i = 0; i < 200; ++i) {
    Vector6d offset;
    for (int k = 0; k < 6; ++k) offset[k] = random.uniform(-1e-4, 1e-4) * (k < 3 ? 1.0 : 0.4);
    const Motion motion =
        motionOf(places, displacedAboutPivot(Pose(), offset, weak.pivot_in_camera_m));
    EXPECT_GT(motion.normal_px / motion.all_px, weak.seen[0] - 0.01);
  }
}

TEST(WeakDirections, TooFewPlaces_DetermineNothing) {
  Places places;
  for (int i = 0; i < 5; ++i) places.add({0.01 * i, 0.0, 0.5}, 0.0, 1.0);
  EXPECT_FALSE(weakDirections(places.result(), camera(), {0.0, 0.0, 0.5}).known);
}

}  // namespace
}  // namespace boresight
