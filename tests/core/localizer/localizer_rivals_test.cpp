// SPDX-License-Identifier: Apache-2.0
// Whole runs on features that repeat: no pose one pitch off is taken for the truth.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/competing_poses.h"
#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

LocalizerOptions weighing() {
  LocalizerOptions options = defaultProfile();
  options.ambiguity.enabled = true;
  return options;
}

bool isRight(const Case& scene, const Pose& estimate) {
  const PitchError error = pitchError(scene, estimate);
  return std::abs(error.pitches) < 0.1 && error.rest_m < 0.0008;
}

TEST(LocalizerRivals, SeeEndsThatTellWhichPitchItIs) {
  int wrong_without = 0;
  for (const double off_pitches : {-1.5, -1.0, -0.5, 0.0, 0.75, 1.25}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      SCOPED_TRACE(off_pitches);
      const Case scene = railCase(Ends::kSeen, off_pitches, 1.7, seed);
      OwnedRun without(scene.problem(), withoutSearch());
      without.finish();
      const Workspace& before = without.localizer.workspace();
      if (before.status == LocalizationStatus::kConverged &&
          !isRight(scene, before.camera_from_station))
        ++wrong_without;
      OwnedRun run(scene.problem(), weighing());
      EXPECT_GT(run.finish(), 0);
      const Workspace& workspace = run.localizer.workspace();
      EXPECT_STREQ(localizationStatusText(workspace.status), "converged");
      EXPECT_TRUE(isRight(scene, workspace.camera_from_station));
      EXPECT_GE(workspace.rivals.size(), 1u);
    }
  }
  EXPECT_GE(wrong_without, 3);  // else these seeds show nothing
}

/// Whatever pitch they lock on, they say so, and nothing is returned but the seed.
TEST(LocalizerRivals, SayThatItStaysAmbiguous) {
  int ambiguous = 0;
  for (const Ends ends : {Ends::kHidden, Ends::kOutside}) {
    for (const double off_pitches : {0.0, 0.5, -0.75}) {
      SCOPED_TRACE(off_pitches);
      const Case scene = railCase(ends, off_pitches, 1.7, 3);
      OwnedRun run(scene.problem(), weighing());
      EXPECT_GT(run.finish(), 0);
      const Workspace& workspace = run.localizer.workspace();
      // What is left to see of the hidden ends may do.
      if (ends == Ends::kHidden && workspace.status == LocalizationStatus::kConverged &&
          isRight(scene, workspace.camera_from_station))
        continue;
      ++ambiguous;
      EXPECT_STREQ(localizationStatusText(workspace.status), "ambiguous");
      EXPECT_EQ(workspace.camera_from_station, scene.seed);
      const Pose best = workspace.iteration->camera_from_station;
      double nearest_pitches = 1e9;
      for (const Rival& rival : workspace.rivals) {
        if (rival.ended != LocalizationStatus::kConverged) continue;
        if (rival.margin_nats >= CompetingPoses::kMinMargin_nats) continue;
        const double apart =
            pitchError(scene, rival.camera_from_station).pitches - pitchError(scene, best).pitches;
        nearest_pitches = std::min(nearest_pitches, std::abs(apart));
      }
      EXPECT_NEAR(nearest_pitches, 1.0, 0.1);
    }
  }
  EXPECT_GE(ambiguous, 4);
}

/// The true place lies outside what was declared: nothing inside is taken for it.
TEST(LocalizerRivals, RefuseWhenTheBestPoseIsOutsideTheSeedsUncertainty) {
  const Case scene = railCase(Ends::kSeen, 1.0, 0.6, 2);
  LocalizerOptions options = weighing();
  options.search.enabled = false;
  options.loop.leave_factor = 1.1;
  OwnedRun without(scene.problem(), withoutSearch());
  without.finish();
  ASSERT_EQ(without.localizer.workspace().status, LocalizationStatus::kConverged);
  ASSERT_FALSE(isRight(scene, without.localizer.workspace().camera_from_station));
  OwnedRun run(scene.problem(), options);
  run.finish();
  EXPECT_STREQ(localizationStatusText(run.localizer.workspace().status), "left_uncertainty");
}

/// What the seed rules out is no ambiguity.
TEST(LocalizerRivals, TakeTheSeedsWordWhereTheImageHasNone) {
  const Case scene = railCase(Ends::kOutside, 0.0, 0.6, 2);
  OwnedRun run(scene.problem(), weighing());
  run.finish();
  const Workspace& workspace = run.localizer.workspace();
  EXPECT_STREQ(localizationStatusText(workspace.status), "converged");
  EXPECT_TRUE(isRight(scene, workspace.camera_from_station));
  EXPECT_GE(workspace.rivals.size(), 1u);
}

/// The lead's last iteration is done again: the run ends with the bits that it had.
TEST(LocalizerRivals, LeaveAPoseThatWasRightAsItIs) {
  for (const Case& scene : {railCase(Ends::kSeen, 0.0, 1.7, 1), stationCase(1), occludedCase(2)}) {
    OwnedRun without(scene.problem(), defaultProfile());
    without.finish();
    OwnedRun run(scene.problem(), weighing());
    run.finish();
    const Workspace& before = without.localizer.workspace();
    const Workspace& after = run.localizer.workspace();
    ASSERT_EQ(before.status, LocalizationStatus::kConverged);
    EXPECT_EQ(after.status, LocalizationStatus::kConverged);
    EXPECT_EQ(after.camera_from_station, before.camera_from_station);
    EXPECT_EQ(after.covariance, before.covariance);
    EXPECT_EQ(after.support.covered, before.support.covered);
    EXPECT_EQ(after.iteration->camera_from_station, before.camera_from_station);
    EXPECT_EQ(after.iteration->refinement.rms_px, before.iteration->refinement.rms_px);
    if (after.rivals.empty()) {
      EXPECT_EQ(after.iterations, before.iterations);
    } else {
      EXPECT_GT(after.attempts, before.attempts);
    }
  }
}

TEST(LocalizerRivals, HoldWithoutRefinementToo) {
  LocalizerOptions options = paperProfile();
  options.support.gate = true;
  options.ambiguity.enabled = true;
  const Case scene = railCase(Ends::kSeen, 1.0, 1.7, 4);
  OwnedRun run(scene.problem(), options);
  EXPECT_GT(run.finish(), 0);
  const Workspace& workspace = run.localizer.workspace();
  if (workspace.status == LocalizationStatus::kConverged) {
    EXPECT_LT(std::abs(pitchError(scene, workspace.camera_from_station).pitches), 0.2);
  }
}

TEST(LocalizerRivals, GiveTheSameBitsWithAnyKernelsAndWorkers) {
  const Case scene = railCase(Ends::kHidden, 0.5, 1.7, 4);
  const LocalizerOptions options = weighing();
  const LocalizationProblem problem = scene.problem();
  OwnedRun plain(problem, options);
  plain.finish();
  for (const int workers : {1, 3})
    EXPECT_EQ(sharedDigest(problem, options, workers), plain.localizer.digest()) << workers;
}

/// Whatever is left of them, loops and memory are bounded.
TEST(LocalizerRivals, EndWithAsManyRivalsAsAllowed) {
  const Case scene = railCase(Ends::kOutside, 0.5, 3.0, 5);
  OwnedRun run(scene.problem(), weighing());
  EXPECT_GT(run.finish(), 0);
  EXPECT_GE(run.localizer.workspace().rivals.size(), 1u);
  EXPECT_LE(run.localizer.workspace().rivals.size(), std::size_t{CompetingPoses::kMaxRivals});
  EXPECT_LE(run.localizer.highWaterBytes(), run.memory.size());
}

TEST(LocalizerRivals, AreHeardOfInDigests) {
  LocalizerOptions options = defaultProfile();
  DigestWriter plain;
  digestOptions(options, plain);
  options.ambiguity.enabled = true;
  DigestWriter changed;
  digestOptions(options, changed);
  EXPECT_NE(changed.digest(), plain.digest());
}

}  // namespace
}  // namespace boresight::test
