// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/schedule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boresight {
namespace {

TEST(Schedule, FirstLevel_IsTheFinestWithinTheSizeLimit) {
  LocalizerOptions options;
  options.loop.coarse_size_px = 512;
  options.loop.halved_size_px = 400;
  const struct {
    int width, height, coarse;
  } images[] = {{2048, 1536, 2}, {1024, 1024, 1}, {1025, 16, 1},  // 1025 >> 1
                {401, 401, 1},   {400, 400, 0},   {1 << 14, 1 << 14, kPyramidLevels - 1}};
  for (const auto& [width, height, coarse] : images)
    EXPECT_EQ(levelsOf({width, height, 8, 12, 1}, options).coarse, coarse) << width;
}

TEST(Schedule, ThresholdsShrinkWhileMatchingAndAreARadiusWhenRefining) {
  LocalizerOptions options;
  options.loop.match_iterations = 4;
  options.loop.shrink_iterations = 2;
  options.loop.threshold_shrink = 0.5;
  options.loop.inlier_threshold_px = 16.0;
  options.refinement.enabled = true;
  const double expected_px[] = {
      16.0, 8.0, 4.0, 4.0, 2.0 * kFirstRadius_px, 2.0 * kLastRadius_px, 2.0 * kLastRadius_px};
  for (int i = 0; i < 7; ++i) EXPECT_EQ(thresholdAt(options, i, 1), expected_px[i]) << i;
  options.refinement.enabled = false;
  EXPECT_EQ(thresholdAt(options, 6, 1), 4.0);
}

TEST(Schedule, RolledRendersCoverTheUncertaintyAboutTheViewAxis) {
  LocalizerOptions options;
  options.loop.max_rolled_hypotheses = 9;
  for (double uncertain_rad = 0.0; uncertain_rad < 4.4 * kRollSpacing_rad; uncertain_rad += 0.001) {
    SeedUncertainty uncertainty;
    uncertainty.rotation_rad.z() = uncertain_rad;
    const int count = rolledHypotheses(options, uncertainty);
    double most_rad = 0.0;
    for (int i = 0; i < count; ++i) most_rad = std::max(most_rad, std::abs(rollOf(i)));
    EXPECT_GE(most_rad + 0.5 * kRollSpacing_rad, uncertain_rad - 1e-12);
    // One pair less would not do.
    if (count > 1) {
      EXPECT_LT(most_rad - 0.5 * kRollSpacing_rad, uncertain_rad);
    }
  }
}

TEST(Schedule, RollsAlternate) {
  const double expected[] = {0.0, 1.0, -1.0, 2.0, -2.0};
  for (int i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(rollOf(i), expected[i] * kRollSpacing_rad);
}

TEST(Schedule, ThePivotMovesWithTheHypothesis) {
  LocalizationProblem problem;
  problem.camera_from_station_seed.translation_m = {0.0, 0.0, 2.0};
  problem.uncertainty.pivot_in_camera_m = {0.1, 0.0, 2.0};
  LoopOptions loop;
  loop.uncertainty_shrink = 0.5;
  loop.shrink_iterations = 3;
  Pose moved = problem.camera_from_station_seed;
  moved.translation_m.x() += 0.5;
  const SeedUncertainty shrunk = uncertaintyAt(seedOf(problem), loop, 2, moved);
  EXPECT_TRUE(shrunk.pivot_in_camera_m.isApprox(Eigen::Vector3d(0.6, 0.0, 2.0)));
  EXPECT_TRUE(shrunk.translation_m.isApprox(0.25 * problem.uncertainty.translation_m));
  problem.uncertainty.pivot_in_camera_m.setZero();  // an arm camera turns about itself
  EXPECT_TRUE(uncertaintyAt(seedOf(problem), loop, 2, moved).pivot_in_camera_m.isZero());
}

TEST(Schedule, Run_MayEndAfterItsLeastNumberOfIterations) {
  LocalizerOptions options;
  options.loop.match_iterations = 2;
  options.loop.converged_iterations = 2;
  EXPECT_EQ(iterationsNeeded(options), 2 + kMinRefinements);
  options.loop.converged_iterations = 7;
  EXPECT_EQ(iterationsNeeded(options), 7);
  options.loop.converged_iterations = 2;
  options.refinement.enabled = false;
  EXPECT_EQ(iterationsNeeded(options), 2);
}

}  // namespace
}  // namespace boresight
