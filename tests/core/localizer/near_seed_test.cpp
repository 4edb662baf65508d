// SPDX-License-Identifier: Apache-2.0
// Runs from a seed whose stated uncertainty is small, as those of a sequence's frames.
#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// +-`size_m` along and +-`size_deg` about each axis through the station's centre.
Case nearCase(std::uint64_t seed, double size_m, double size_deg, double share = 0.9) {
  Case scene = stationCase(seed);
  scene.uncertainty.translation_m.setConstant(size_m);
  scene.uncertainty.rotation_rad.setConstant(size_deg * kDegree_rad);
  scene.seed = displacedSeed(scene.truth, scene.uncertainty, share, seed);
  return scene;
}

/// 0.6 mm and 0.12 deg move the scene by 2 px of the 3 px that a refinement searches.
TEST(NearSeed, WithinReachOfARefinement_IsRefinedAtOnce) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Case scene = nearCase(seed, 0.0006, 0.12);
    OwnedRun run(scene.problem(), defaultProfile());
    run.finish();
    const Workspace& workspace = run.localizer.workspace();
    expectTruth(scene, workspace);
    EXPECT_EQ(workspace.attempts, 1);
    EXPECT_TRUE(workspace.candidates.empty());
  }
}

TEST(NearSeed, IsRefinedWithoutASearch) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Case scene = nearCase(seed, 0.005, 1.0);
    OwnedRun run(scene.problem(), defaultProfile());
    run.finish();
    const Workspace& workspace = run.localizer.workspace();
    expectTruth(scene, workspace);
    EXPECT_EQ(workspace.attempts, 1);
    EXPECT_EQ(workspace.candidates.size(), 1u);
    EXPECT_TRUE(workspace.hypotheses.empty());
  }
}

/// Three times as far: also beyond the box of a wider search.
TEST(NearSeed, WhoseTruthIsFartherThanStated_IsSearchedFor) {
  const Case scene = nearCase(2, 0.005, 1.0, 3.0);
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish();
  const Workspace& workspace = run.localizer.workspace();
  EXPECT_GT(workspace.attempts, 1);
  if (workspace.status == LocalizationStatus::kConverged) expectTruth(scene, workspace);
}

TEST(NearSeed, WithoutTheObjectInTheImage_IsRefusedAfterASearch) {
  Case scene = nearCase(1, 0.005, 1.0);
  const Picture flat = flatPicture(512, 512, 90);
  scene.picture = &flat;
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish();
  const Workspace& workspace = run.localizer.workspace();
  EXPECT_NE(workspace.status, LocalizationStatus::kConverged);
  EXPECT_EQ(workspace.camera_from_station, scene.seed);
  EXPECT_GT(workspace.attempts, 1);
}

TEST(NearSeed, ThatIsImprobable_IsSearchedForToo) {
  const Case scene = nearCase(3, 0.005, 1.0);
  LocalizerOptions options = defaultProfile();
  options.support.min_probability = 1.0;
  OwnedRun run(scene.problem(), options);
  run.finish();
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kNotSupported);
  EXPECT_GT(run.localizer.workspace().attempts, 1);
  EXPECT_FALSE(run.localizer.workspace().hypotheses.empty());
}

TEST(NearSeed, WideUncertainty_IsSearchedAtOnce) {
  const Case scene = nearCase(1, 0.02, 4.0, 0.2);
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish();
  expectTruth(scene, run.localizer.workspace());
  EXPECT_FALSE(run.localizer.workspace().hypotheses.empty());
}

TEST(NearSeed, OptionsChangedBeforeTheFirstIteration_StartFromTheRefinedSeedAgain) {
  const Case scene = nearCase(5, 0.005, 1.0);
  OwnedRun run(scene.problem(), defaultProfile());
  while (!run.localizer.isBetweenIterations()) run.localizer.step();
  LocalizerOptions other = defaultProfile();
  other.loop.match_iterations = 1;
  ASSERT_TRUE(run.localizer.changeOptions(other));
  run.finish();
  expectTruth(scene, run.localizer.workspace());
  EXPECT_EQ(run.localizer.workspace().attempts, 1);
}

TEST(NearSeed, AnyKernelsAndWorkers_GiveTheSameBits) {
  const Case scene = nearCase(4, 0.005, 1.0);
  OwnedRun plain(scene.problem(), defaultProfile());
  plain.finish();
  EXPECT_EQ(sharedDigest(scene.problem(), defaultProfile(), 3), plain.localizer.digest());
}

}  // namespace
}  // namespace boresight::test
