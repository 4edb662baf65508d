// SPDX-License-Identifier: Apache-2.0
// Whole runs from seeds far off.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/localizer/localizer.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

LocalizerOptions turning(double range_rad, TurnAxis axis = TurnAxis::kView) {
  LocalizerOptions options = defaultProfile();
  options.wide.rotation_rad = range_rad;
  options.wide.rotation_axis = axis;
  return options;
}

/// The seed turned about the station's middle, which the uncertainty says nothing of.
Case turnedCase(std::uint64_t seed, double turn_rad, TurnAxis axis = TurnAxis::kView) {
  Case made = stationCase(seed);
  const BoundingBox scene = matchedBounds(made.solid.view());
  const Eigen::Vector3d middle_m = made.seed * scene.centre();
  Eigen::Vector3d about = middle_m.normalized();
  if (axis != TurnAxis::kView) about = made.seed.matrix().col(static_cast<int>(axis) - 1);
  const Eigen::Quaterniond turn = rotationExp(about * turn_rad);
  made.seed.rotation = (turn * made.seed.rotation).normalized();
  made.seed.translation_m = turn * (made.seed.translation_m - middle_m) + middle_m;
  return made;
}

void expectTruth(const Case& scene, const Workspace& workspace) {
  EXPECT_STREQ(localizationStatusText(workspace.status), "converged");
  const PoseError error = poseError(scene.solid, scene.truth, workspace.camera_from_station);
  EXPECT_LT(error.centre_m, 0.0001);
  EXPECT_LT(error.angle_rad, 0.06 * kDegree_rad);
}

LocalizationStatus endOf(const Case& scene, const LocalizerOptions& options) {
  OwnedRun run(scene.problem(), options);
  run.finish();
  return run.localizer.workspace().status;
}

TEST(LocalizerWide, FindsASeedTurnedAnywhereAboutTheView) {
  for (const double turn_deg : {-160.0, 35.0, 100.0, 180.0}) {
    SCOPED_TRACE(turn_deg);
    const Case scene = turnedCase(3, turn_deg * kDegree_rad);
    EXPECT_NE(endOf(scene, defaultProfile()), LocalizationStatus::kConverged);
    OwnedRun run(scene.problem(), turning(kPi));
    EXPECT_GT(run.finish(), 0);
    expectTruth(scene, run.localizer.workspace());
  }
}

TEST(LocalizerWide, FindsASeedTurnedAboutAnAxisOfTheStation) {
  const Case scene = turnedCase(5, 70.0 * kDegree_rad, TurnAxis::kStationZ);
  EXPECT_NE(endOf(scene, defaultProfile()), LocalizationStatus::kConverged);
  OwnedRun run(scene.problem(), turning(90.0 * kDegree_rad, TurnAxis::kStationZ));
  run.finish();
  expectTruth(scene, run.localizer.workspace());
}

TEST(LocalizerWide, FindsASeed75MillimetresOff) {
  LocalizerOptions options = defaultProfile();
  options.wide.translation_m = 0.075;
  for (const Eigen::Vector3d& off_m :
       {Eigen::Vector3d(0.0, 0.0, 0.075), Eigen::Vector3d(0.0, 0.0, -0.075),
        Eigen::Vector3d(0.06, -0.03, 0.03)}) {
    SCOPED_TRACE(off_m.transpose());
    Case scene = stationCase(7);
    scene.seed.translation_m = scene.truth.translation_m + off_m;
    EXPECT_NE(endOf(scene, defaultProfile()), LocalizationStatus::kConverged);
    OwnedRun run(scene.problem(), options);
    run.finish();
    expectTruth(scene, run.localizer.workspace());
  }
}

/// Every restart is there to be looked at; the one chosen has the most evidence.
TEST(LocalizerWide, ShowsWhatEveryRestartCameTo) {
  const Case scene = turnedCase(3, 100.0 * kDegree_rad);
  OwnedRun run(scene.problem(), turning(kPi));
  std::vector<std::size_t> rounds;
  for (StepReport report; !report.finished;) {
    report = run.localizer.step();
    const Iteration* now = run.localizer.workspace().iteration;
    if (!report.iteration_complete || now->restarts.empty()) continue;
    rounds.push_back(now->restarts.size());
    const auto most =
        std::max_element(now->restarts.begin(), now->restarts.end(),
                         [](const auto& a, const auto& b) { return a.evidence() < b.evidence(); });
    EXPECT_EQ(most - now->restarts.begin(), now->chosen_hypothesis);
    EXPECT_EQ(most->camera_from_station, now->camera_from_station);
    EXPECT_NEAR(std::abs(most->roll_rad), 100.0 * kDegree_rad, 8.0 * kDegree_rad);
    EXPECT_GT(most->support, 0.3);
    EXPECT_GT(most->edge_nats, 0.0);
    EXPECT_GT(most->inlier_nats, 0.0);
  }
  ASSERT_EQ(rounds.size(), 2u);
  EXPECT_EQ(rounds[0], 45u);
  EXPECT_LE(rounds[1], 3u);
}

TEST(LocalizerWide, FindsNothingInNoise) {
  const Picture noise = noisePicture(512, 512, 5);
  Case scene = stationCase(1);
  scene.picture = &noise;
  LocalizerOptions options = turning(kPi);
  EXPECT_NE(endOf(scene, options), LocalizationStatus::kConverged);
  options.wide.translation_m = 0.075;
  options.wide.max_restarts = 40;
  EXPECT_NE(endOf(scene, options), LocalizationStatus::kConverged);
}

TEST(LocalizerWide, ADeadImageFailsWithTheSeed) {
  const Picture flat = flatPicture(512, 512, 80);
  Case scene = stationCase(1);
  scene.picture = &flat;
  OwnedRun run(scene.problem(), turning(kPi));
  EXPECT_GT(run.finish(), 0);
  EXPECT_NE(run.localizer.workspace().status, LocalizationStatus::kConverged);
  EXPECT_EQ(run.localizer.workspace().camera_from_station, scene.seed);
}

/// Whatever fails goes on with the next finalist, and ends when there is none.
TEST(LocalizerWide, FurtherAttemptsGoOnWithTheNextBest) {
  const Case scene = turnedCase(3, 100.0 * kDegree_rad);
  LocalizerOptions options = turning(kPi);
  options.support.min_support = 0.999;
  OwnedRun run(scene.problem(), options);
  EXPECT_GT(run.finish(), 0);
  EXPECT_NE(run.localizer.workspace().status, LocalizationStatus::kConverged);
  EXPECT_GT(run.localizer.workspace().attempts, 1);
  EXPECT_LE(run.localizer.workspace().attempts, options.wide.finalists);
}

TEST(LocalizerWide, GivesTheSameBitsWithAnyKernelsAndWorkers) {
  const Case scene = turnedCase(4, -130.0 * kDegree_rad);
  LocalizerOptions options = turning(kPi);
  options.wide.rotation_spacing_rad = 20.0 * kDegree_rad;
  const LocalizationProblem problem = scene.problem();
  OwnedRun plain(problem, options);
  plain.finish();
  for (const int workers : {1, 3})
    EXPECT_EQ(sharedDigest(problem, options, workers), plain.localizer.digest()) << workers;
}

}  // namespace
}  // namespace boresight::test
