// SPDX-License-Identifier: Apache-2.0
#include "core/refine/weak_directions.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/geometry/example_cameras.h"

namespace boresight {
namespace {

constexpr double kFocal_px = 1000.0;

Camera camera() { return test::makePinhole(1024, 1024, kFocal_px); }

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

/// Edges in all directions, which determine everything.
Places randomPlaces(Random& random, const Eigen::Vector2d& half_m, double near_m, double far_m) {
  Places places;
  for (int i = 0; i < 300; ++i) {
    const double angle_rad = random.uniform(0.0, 6.283);
    places.add({random.uniform(-1.0, 1.0) * half_m.x(), random.uniform(-1.0, 1.0) * half_m.y(),
                random.uniform(near_m, far_m)},
               std::cos(angle_rad), std::sin(angle_rad));
  }
  return places;
}

/// Root mean square of the places' motion when the pose moves: of all of it, and along the normals.
struct Motion {
  double all_px = 0.0;
  double normal_px = 0.0;
};

Motion motionOf(const Places& places, const Pose& moved, const Pose& camera_from_first = Pose()) {
  Motion motion;
  for (const EdgeSample& sample : places.samples) {
    const Eigen::Vector3d& point_m = sample.point_in_station_m;
    const Eigen::Vector2d motion_px =
        test::pixelOf(camera(), camera_from_first * (moved * point_m)) -
        test::pixelOf(camera(), camera_from_first * point_m);
    motion.all_px += motion_px.squaredNorm();
    motion.normal_px += std::pow(sample.normal().dot(motion_px), 2);
  }
  const auto count = static_cast<double>(places.samples.size());
  return {std::sqrt(motion.all_px / count), std::sqrt(motion.normal_px / count)};
}

TEST(WeakDirections, NoOtherDirection_IsWeaker) {
  Random random(3);
  Places places = randomPlaces(random, {0.05, 0.03}, 0.4, 0.5);
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

/// A slide along the bar is known as the seed knows it, and nothing else has changed.
TEST(WeakDirections, LongBar_IsWeakAlongItselfAndKeepsTheSeedsVarianceThere) {
  Places places;
  for (int i = -50; i <= 50; ++i)
    for (const double side : {-1.0, 1.0})
      for (const double z_m : {0.45, 0.55}) places.add({0.002 * i, 0.05 * side, z_m}, 0.0, side);
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
  ASSERT_TRUE(weak.isUndetermined(0));
  EXPECT_FALSE(weak.isUndetermined(1));
  SeedUncertainty uncertainty;
  uncertainty.translation_m = {0.03, 0.02, 0.01};
  const Matrix6d before = 1e-10 * Matrix6d::Identity();
  const Matrix6d after = withUndetermined(before, weak, uncertainty);
  EXPECT_NEAR(std::sqrt(after(3, 3)), 0.03 / std::sqrt(3.0), 2e-4);
  for (const int other : {4, 5}) EXPECT_LT(std::sqrt(after(other, other)), 1e-3);
  EXPECT_LT((after - after.transpose()).norm(), 1e-18);
  uncertainty.translation_m.x() = 0.0;  // known by the seed
  EXPECT_LT((withUndetermined(before, weak, uncertainty) - before).norm(), 1e-12);
}

/// Circles about an axis along the line of sight, off the camera's own axis.
TEST(WeakDirections, UndeterminedTurn_IsAboutItsOwnAxis) {
  Places places;
  const Eigen::Vector3d middle_m(0.05, 0.02, 0.5);
  for (int i = 0; i < 100; ++i)
    for (const double z_m : {0.45, 0.55}) {
      const double angle_rad = 0.0628318 * i;
      const Eigen::Vector2d out(std::cos(angle_rad), std::sin(angle_rad));
      places.add({middle_m.x() + 0.03 * out.x(), middle_m.y() + 0.03 * out.y(), z_m}, out.x(),
                 out.y());
    }
  const WeakDirections weak = weakDirections(places.result(), camera(), middle_m);
  ASSERT_TRUE(weak.isUndetermined(0));
  EXPECT_FALSE(weak.isUndetermined(1));
  SeedUncertainty uncertainty;
  uncertainty.pivot_in_camera_m = middle_m;
  const Matrix6d after = withUndetermined(1e-12 * Matrix6d::Identity(), weak, uncertainty);
  EXPECT_NEAR(std::sqrt(after(2, 2)), uncertainty.rotation_rad.z() / std::sqrt(3.0), 1e-3);
  for (const int other : {0, 1}) EXPECT_LT(std::sqrt(after(other, other)), 1e-3);
  Eigen::Matrix<double, 3, 6> moves;  // of the middle
  moves << 0.0, middle_m.z(), -middle_m.y(), 1.0, 0.0, 0.0, -middle_m.z(), 0.0, middle_m.x(), 0.0,
      1.0, 0.0, middle_m.y(), -middle_m.x(), 0.0, 0.0, 0.0, 1.0;
  EXPECT_LT((moves * after * moves.transpose()).diagonal().maxCoeff(), 1e-7);
}

/// The second camera sees the bar's ends: together the two views determine the slide.
TEST(WeakDirections, SecondView_DeterminesWhatTheFirstLeaves) {
  Places along;
  Places ends;
  for (int i = -50; i <= 50; ++i)
    for (const double side : {-1.0, 1.0}) {
      along.add({0.002 * i, 0.01 * side, 0.5 + 0.0005 * i}, 0.0, side);
      ends.add({0.1 * side, 0.0002 * i, 0.5}, 0.0, 1.0);
    }
  // The second camera is rolled by a right angle: the first one's x axis is its y axis.
  const Pose second_from_first{rotationExp({0.0, 0.0, 1.5707963267948966}), {0.01, 0.02, 0.0}};
  RefinementResult seen_by_second = ends.result();
  seen_by_second.camera_from_station = second_from_first;
  const Eigen::Vector3d pivot_m(0.0, 0.0, 0.5);
  EdgeMotion first_alone(pivot_m);
  first_alone.add(along.result(), camera());
  EXPECT_TRUE(first_alone.weakDirections().isUndetermined(0));
  EdgeMotion both = first_alone;
  both.add(seen_by_second, camera(), second_from_first);
  const WeakDirections weak = both.weakDirections();
  ASSERT_TRUE(weak.known);
  // Whatever is weak now is not the slide: it moves the ends along their normals.
  for (std::size_t k = 0; k < 2; ++k) {
    const Pose moved = weak.moved(Pose(), static_cast<int>(k), 0.01);
    const Motion of_first = motionOf(along, moved);
    const Motion of_second = motionOf(ends, moved, second_from_first);
    const double all_px = std::hypot(of_first.all_px, of_second.all_px);
    EXPECT_NEAR(std::sqrt(0.5) * all_px, 0.01, 1e-4);
    EXPECT_NEAR(std::hypot(of_first.normal_px, of_second.normal_px) / all_px, weak.seen[k], 0.01);
  }
  const WeakDirections alone = first_alone.weakDirections();
  EXPECT_GT(weak.seen[0], alone.seen[0] + 0.05);
}

TEST(WeakDirections, DeterminedPose_KeepsItsCovariance) {
  Random random(5);
  Places places = randomPlaces(random, {0.1, 0.1}, 0.3, 0.6);
  const WeakDirections weak = weakDirections(places.result(), camera(), {0.0, 0.0, 0.45});
  const Matrix6d covariance = 1e-8 * Matrix6d::Identity();
  EXPECT_EQ(withUndetermined(covariance, weak, SeedUncertainty()), covariance);
}

TEST(WeakDirections, TooFewPlaces_DetermineNothing) {
  Places places;
  for (int i = 0; i < 5; ++i) places.add({0.01 * i, 0.0, 0.5}, 0.0, 1.0);
  EXPECT_FALSE(weakDirections(places.result(), camera(), {0.0, 0.0, 0.5}).known);
}

}  // namespace
}  // namespace boresight
