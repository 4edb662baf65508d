// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_places.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/geometry/example_cameras.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

Camera edgeCamera() { return test::makePinhole(1024, 1024, 1000.0); }

Vector6d perturbation(Random& random, double rotation_rad, double translation_m) {
  Vector6d xi;
  xi << test::randomVector(random, rotation_rad), test::randomVector(random, translation_m);
  return xi;
}

std::vector<EdgeSample> randomSamples(Random& random, int count) {
  std::vector<EdgeSample> samples(static_cast<std::size_t>(count));
  for (EdgeSample& sample : samples) {
    sample.point_in_station_m = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                                 random.uniform(-0.05, 0.05)};
    const double angle_rad = random.uniform(0.0, 6.283);
    sample.normal_x = static_cast<std::int8_t>(std::lround(127.0 * std::cos(angle_rad)));
    sample.normal_y = static_cast<std::int8_t>(std::lround(127.0 * std::sin(angle_rad)));
  }
  return samples;
}

RefinementResult resultOf(std::vector<EdgeSample>& samples) {
  RefinementResult refined;
  refined.camera_from_station.translation_m = {0.0, 0.0, 0.6};
  refined.samples = samples;
  refined.sample_count = static_cast<std::int32_t>(samples.size());
  return refined;
}

/// The same quantile over all samples.
double motion_px(const std::vector<EdgeSample>& samples, const Pose& from, const Pose& to) {
  std::vector<double> motions_px;
  for (const EdgeSample& sample : samples) {
    Eigen::Vector2d before;
    Eigen::Vector2d after;
    (void)project(edgeCamera(), from * sample.point_in_station_m, before);
    (void)project(edgeCamera(), to * sample.point_in_station_m, after);
    motions_px.push_back(std::abs((after - before).dot(sample.normal())));
  }
  std::sort(motions_px.begin(), motions_px.end());
  return motions_px[static_cast<std::size_t>(0.8 * static_cast<double>(motions_px.size() - 1))];
}

TEST(EdgePlaces, Motion_IsTheQuantileAlongTheNormals) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<EdgeSample> few = randomSamples(random, EdgePlaces::kMost);
    const RefinementResult refined = resultOf(few);
    const EdgePlaces places(refined, edgeCamera());
    EXPECT_NEAR(places.motionTo(refined.camera_from_station)->rms_px, 0.0, 1e-3);
    const Pose to = perturbed(perturbation(random, 0.05, 0.02), refined.camera_from_station);
    const double expected_px = motion_px(few, refined.camera_from_station, to);
    EXPECT_NEAR(places.motionTo(to)->quantile_px, expected_px, 1e-3);
    // Poses in another camera's frame.
    const Pose camera_from_first = perturbed(perturbation(random, 0.2, 0.1), Pose());
    const EdgePlaces second(refined, edgeCamera(), camera_from_first);
    EXPECT_NEAR(second.motionTo(camera_from_first.inverse() * to)->quantile_px, expected_px, 1e-3);
    // A selection of many.
    std::vector<EdgeSample> many = randomSamples(random, 3000);
    const RefinementResult of_many = resultOf(many);
    EXPECT_NEAR(EdgePlaces(of_many, edgeCamera()).motionTo(to)->quantile_px,
                motion_px(many, of_many.camera_from_station, to), 0.25 * expected_px);
  }
}

TEST(EdgePlaces, FewPlaces_MeasureNothingAndUnseenOnesHaveMovedWithoutBound) {
  EXPECT_FALSE(EdgePlaces().motionTo(Pose()));
  Random random(4);
  std::vector<EdgeSample> samples = randomSamples(random, EdgePlaces::kLeast);
  RefinementResult refined = resultOf(samples);
  Pose behind = refined.camera_from_station;
  behind.translation_m.z() = -1.0;
  EXPECT_GT(EdgePlaces(refined, edgeCamera()).motionTo(behind)->quantile_px, 1e5);
  --refined.sample_count;
  EXPECT_FALSE(EdgePlaces(refined, edgeCamera()).motionTo(behind));
}

}  // namespace
}  // namespace boresight
