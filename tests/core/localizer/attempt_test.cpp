// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/attempt.h"

#include <gtest/gtest.h>

#include "tests/core/localizer/scripted_pass.h"

namespace boresight {
namespace {

using test::movedBy;
using test::ScriptedPass;
using test::seedInFront;

class AttemptTest : public testing::Test {
 protected:
  Ruling takeMatch(const Pose& pose, int inliers) {
    const Agreement agreement = pass.match(attempt.plan(pass.context()), pose, inliers);
    return attempt.take(pass.outcome, agreement, pass.context(), pass.records);
  }
  Ruling takeRefinement(const Pose& pose) {
    pass.refine(attempt.plan(pass.context()), pose);
    return attempt.take(pass.outcome, {}, pass.context(), pass.records);
  }

  ScriptedPass pass;
  const Seed seed = seedInFront();
  const Pose found = movedBy(seed.camera_from_station, 0.01);
  Attempt attempt{0, seed};
};

TEST_F(AttemptTest, ConvincingFirstHypothesis_EndsTheIteration) {
  const Ruling ruling = takeMatch(found, 80);  // of 90 matches
  EXPECT_EQ(ruling.next, Ruling::Next::kPass);
  EXPECT_TRUE(ruling.iteration_complete);
  EXPECT_EQ(pass.records[0].hypothesis_count, 1);
  EXPECT_NEAR(pass.records[0].correction_translation_m, 0.01, 1e-12);
  EXPECT_EQ(attempt.camera_from_station(), found);
}

TEST_F(AttemptTest, UnconvincingHypotheses_KeepTheOneWithMostInliers) {
  const int inliers[] = {10, 30, 20};
  Ruling ruling;
  int tried = 0;
  for (; !ruling.iteration_complete; ++tried) {
    ASSERT_LT(tried, 3);
    ruling = takeMatch(movedBy(found, 0.001 * tried), inliers[tried]);
  }
  EXPECT_EQ(tried, rolledHypotheses(pass.options, seed.uncertainty));
  const Iteration& shown = pass.records[static_cast<std::size_t>(ruling.record)];
  EXPECT_EQ(shown.chosen_hypothesis, 1);
  EXPECT_EQ(shown.hypothesis_count, tried);
  EXPECT_EQ(shown.hypotheses[2].inliers, 20);
  EXPECT_EQ(attempt.camera_from_station(), movedBy(found, 0.001));
}

TEST_F(AttemptTest, HypothesisAfterABetterOne_FillsTheOtherRecord) {
  (void)takeMatch(found, 30);
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
  (void)takeMatch(found, 10);  // worse: its record is free again
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
}

TEST_F(AttemptTest, LaterIterations_ShrinkWindowsAndThreshold) {
  const PassPlan first = attempt.plan(pass.context());
  (void)takeMatch(found, 80);
  const PassPlan second = attempt.plan(pass.context());
  EXPECT_EQ(second.level, first.level - 1);
  EXPECT_EQ(second.threshold_px, 0.5 * first.threshold_px);
  EXPECT_EQ(second.uncertainty.rotation_rad, 0.5 * first.uncertainty.rotation_rad);
  EXPECT_EQ(second.camera_from_station, found);
}

TEST_F(AttemptTest, SmallCorrectionsInARow_Converge) {
  (void)takeMatch(found, 80);
  (void)takeMatch(found, 80);
  EXPECT_EQ(attempt.plan(pass.context()).kind, PassKind::kRefine);
  Ruling ruling = takeRefinement(movedBy(found, 0.002));  // 12 px: not small
  int refinements = 1;
  for (; ruling.next == Ruling::Next::kPass; ++refinements) {
    ASSERT_LT(refinements, 10);
    ruling = takeRefinement(movedBy(found, 0.002));
  }
  EXPECT_TRUE(ruling.found());
  EXPECT_EQ(refinements, 1 + pass.options.loop.converged_iterations);
  EXPECT_EQ(attempt.covariance(), Matrix6d(Matrix6d::Identity() * 1e-10));
}

TEST_F(AttemptTest, CorrectionsThatStayLarge_EndAtTheIterationLimit) {
  Ruling ruling = takeMatch(found, 80);
  int iterations = 1;
  for (; ruling.next == Ruling::Next::kPass; ++iterations) {
    const Pose next = movedBy(found, iterations % 2 == 0 ? 0.0 : 0.005);
    ruling = iterations == 1 ? takeMatch(next, 80) : takeRefinement(next);
  }
  EXPECT_TRUE(ruling.failed());
  EXPECT_EQ(ruling.status, LocalizationStatus::kIterationLimit);
  EXPECT_EQ(iterations, pass.options.loop.max_iterations);
}

TEST_F(AttemptTest, RefinementBeyondTheUncertainty_Fails) {
  (void)takeMatch(found, 80);
  (void)takeMatch(found, 80);
  const Ruling ruling = takeRefinement(movedBy(seed.camera_from_station, 0.046));  // of 0.045
  EXPECT_TRUE(ruling.failed());
  EXPECT_EQ(ruling.status, LocalizationStatus::kLeftUncertainty);
}

TEST_F(AttemptTest, MatchedPoseBeyondTheUncertainty_IsPulledBack) {
  (void)takeMatch(movedBy(seed.camera_from_station, 0.05), 80);
  EXPECT_NEAR(attempt.camera_from_station().translation_m.x(), 0.03, 1e-12);
}

TEST_F(AttemptTest, FailedHypotheses_FailWithTheReasonOfTheKeptOne) {
  Ruling ruling;
  while (ruling.next == Ruling::Next::kPass) {
    const Agreement none = pass.fail(attempt.plan(pass.context()), Stage::kTemplates,
                                     LocalizationStatus::kTooFewTemplates);
    ruling = attempt.take(pass.outcome, none, pass.context(), pass.records);
  }
  EXPECT_EQ(ruling.status, LocalizationStatus::kTooFewTemplates);
  EXPECT_EQ(ruling.stage, Stage::kTemplates);
}

TEST_F(AttemptTest, Restart_BeginsAtTheSeedWithLargerTemplates) {
  (void)takeMatch(found, 80);
  attempt.restart();
  const PassPlan plan = attempt.plan(pass.context());
  EXPECT_EQ(plan.attempt, 1);
  EXPECT_EQ(plan.camera_from_station, seed.camera_from_station);
  EXPECT_EQ(plan.template_factor, 2.0);
  EXPECT_EQ(plan.level, pass.context().levels.coarse);
}

}  // namespace
}  // namespace boresight
