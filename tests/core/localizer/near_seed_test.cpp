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

/// 0.6 mm and 0.12 deg move the scene by 2 px of the 3 px that a refinement searches: such a seed
/// is refined at once.
TEST(NearSeed, IsRefinedWithoutASearchOfTheWholeObject) {
  const struct {
    double size_m, size_deg;
    std::uint64_t seeds;
    std::size_t candidates;
  } boxes[] = {{0.0006, 0.12, 4, 0}, {0.005, 1.0, 6, 1}};
  for (const auto& box : boxes) {
    for (std::uint64_t seed = 1; seed <= box.seeds; ++seed) {
      SCOPED_TRACE(testing::Message() << box.size_m << " m, seed " << seed);
      const Case scene = nearCase(seed, box.size_m, box.size_deg);
      const FinishedRun run(scene);
      expectTruth(scene, run.workspace);
      EXPECT_EQ(run.workspace.attempts, 1);
      EXPECT_EQ(run.workspace.candidates.size(), box.candidates);
      EXPECT_TRUE(run.workspace.hypotheses.empty());
    }
  }
}

/// Three times as far: also beyond the box of a wider search.
TEST(NearSeed, WhoseTruthIsFartherThanStated_IsSearchedFor) {
  const Case scene = nearCase(2, 0.005, 1.0, 3.0);
  const FinishedRun run(scene);
  EXPECT_GT(run.workspace.attempts, 1);
  if (run.workspace.status == LocalizationStatus::kConverged) expectTruth(scene, run.workspace);
}

TEST(NearSeed, WithoutTheObjectInTheImage_IsRefusedAfterASearch) {
  Case scene = nearCase(1, 0.005, 1.0);
  const Picture flat = flatPicture(512, 512, 90);
  scene.picture = &flat;
  const FinishedRun run(scene);
  EXPECT_NE(run.workspace.status, LocalizationStatus::kConverged);
  EXPECT_GT(run.workspace.attempts, 1);
}

TEST(NearSeed, ThatIsImprobable_IsSearchedForToo) {
  const Case scene = nearCase(3, 0.005, 1.0);
  LocalizerOptions options = defaultProfile();
  options.support.min_probability = 1.0;
  const FinishedRun run(scene, options);
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kNotSupported);
  EXPECT_GT(run.workspace.attempts, 1);
  EXPECT_FALSE(run.workspace.hypotheses.empty());
}

TEST(NearSeed, OptionsChangedBeforeTheFirstIteration_StartFromTheRefinedSeedAgain) {
  const Case scene = nearCase(5, 0.005, 1.0);
  OwnedRun run(scene.problem(), defaultProfile());
  while (!run.localizer.isBetweenIterations()) run.localizer.step();
  LocalizerOptions other = defaultProfile();
  other.loop.match_iterations = 1;
  ASSERT_TRUE(run.localizer.changeOptions(other));
  run.finish();
  expectTruth(scene, run.workspace);
  EXPECT_EQ(run.workspace.attempts, 1);
}

TEST(NearSeed, AnyKernelsAndWorkers_GiveTheSameBits) {
  const Case scene = nearCase(4, 0.005, 1.0);
  EXPECT_EQ(sharedDigest(scene.problem(), defaultProfile(), 3),
            digestOf(scene.problem(), defaultProfile()));
}

}  // namespace
}  // namespace boresight::test
