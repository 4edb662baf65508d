// SPDX-License-Identifier: Apache-2.0
// Whole runs with warped templates.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

constexpr double kFar_rad = 20.0 * kDegree_rad;

LocalizerOptions warping() {
  LocalizerOptions options = defaultProfile();
  options.warp.enabled = true;
  return options;
}

/// Rolled about the ray to the station, as far as it says that it may be.
Case rolledCase(std::uint64_t seed, double roll_rad) {
  Case made = stationCase(seed);
  const Eigen::Vector3d middle_m = made.seed * matchedBounds(made.solid.view()).centre();
  const Eigen::Quaterniond turn = rotationExp(middle_m.normalized() * roll_rad);
  made.seed.rotation = (turn * made.seed.rotation).normalized();
  made.seed.translation_m = turn * (made.seed.translation_m - middle_m) + middle_m;
  made.uncertainty.rotation_rad.z() = kFar_rad + 4.0 * kDegree_rad;
  return made;
}

void expectTruth(const Case& scene, const Workspace& workspace) {
  EXPECT_STREQ(localizationStatusText(workspace.status), "converged");
  const PoseError error = poseError(scene.solid, scene.truth, workspace.camera_from_station);
  EXPECT_LT(error.centre_m, 0.0001);
  EXPECT_LT(error.angle_rad, 0.06 * kDegree_rad);
}

/// Steps to the end of an iteration.
void finishIteration(Localizer& localizer) {
  StepReport made;
  do {
    made = localizer.step();
  } while (!made.iteration_complete && !made.finished);
}

TEST(LocalizerWarp, FindsSeedsRolledFarByOneRender) {
  for (const double roll_rad : {-kFar_rad, -0.5 * kFar_rad, 0.7 * kFar_rad, kFar_rad}) {
    SCOPED_TRACE(roll_rad / kDegree_rad);
    const Case scene = rolledCase(11, roll_rad);
    OwnedRun run(scene.problem(), warping());
    finishIteration(run.localizer);
    const Iteration& first = *run.localizer.workspace().iteration;
    EXPECT_EQ(first.hypothesis_count, 1);
    std::vector<double> rolls_rad;
    for (std::int32_t i = 0; i < first.correspondence_count; ++i) {
      if (first.pnp.inlier[static_cast<std::size_t>(i)] == 0) continue;
      const auto index = static_cast<std::size_t>(first.template_of[static_cast<std::size_t>(i)]);
      rolls_rad.push_back(first.matches.matches[index].warp.roll_rad);
    }
    ASSERT_GE(rolls_rad.size(), 10u);
    std::nth_element(rolls_rad.begin(), rolls_rad.begin() + 5, rolls_rad.end());
    // Templates are turned back to the truth.
    EXPECT_NEAR(rolls_rad[5], -roll_rad, 8.0 * kDegree_rad);
    run.finish();
    expectTruth(scene, run.localizer.workspace());
  }
}

TEST(LocalizerWarp, WarpsAsManyIterationsAsAsked) {
  const Case scene = rolledCase(12, 0.2);
  for (const std::int32_t iterations : {1, 2}) {
    LocalizerOptions options = warping();
    options.warp.iterations = iterations;
    options.warp.tolerance_px = 0.5;
    OwnedRun run(scene.problem(), options);
    for (std::int32_t i = 0; i < 2; ++i) {
      finishIteration(run.localizer);
      const MatchSet& made = run.localizer.workspace().iteration->matches;
      const auto matches = made.matches.first(static_cast<std::size_t>(made.count));
      const bool warped = std::any_of(matches.begin(), matches.end(), [](const Match& match) {
        return match.searched && !(match.warp == TemplateWarp());
      });
      EXPECT_EQ(warped, i < iterations) << i;
    }
    run.finish();
    expectTruth(scene, run.localizer.workspace());
  }
}

TEST(LocalizerWarp, GivesTheSameBitsWithAnyKernelsAndWorkers) {
  const Case scene = rolledCase(13, -0.25);
  const LocalizerOptions options = warping();
  OwnedRun plain(scene.problem(), options);
  plain.finish();
  for (const int workers : {1, 3})
    EXPECT_EQ(sharedDigest(scene.problem(), options, workers), plain.localizer.digest());
}

TEST(LocalizerWarp, DigestTellsHowTemplatesWereWarped) {
  const Case scene = rolledCase(14, 0.1);
  LocalizerOptions other = warping();
  other.warp.tolerance_px = 3.0;
  OwnedRun plain(scene.problem(), defaultProfile()), warped(scene.problem(), warping()),
      coarser(scene.problem(), other);
  for (OwnedRun* run : {&plain, &warped, &coarser}) run->finish();
  EXPECT_NE(plain.localizer.digest(), warped.localizer.digest());
  EXPECT_NE(coarser.localizer.digest(), warped.localizer.digest());
}

TEST(LocalizerWarp, TakesLessMemoryThanRolledRenders) {
  const Case scene = stationCase(3);
  EXPECT_LT(blockFor(scene.problem(), warping()).size(),
            blockFor(scene.problem(), defaultProfile()).size());
}

}  // namespace
}  // namespace boresight::test
