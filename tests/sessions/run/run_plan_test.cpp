// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/run_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/run/runner.h"
#include "tests/support/example_case.h"

namespace boresight::sessions {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const test::ExampleCase& example() {
  static const test::ExampleCase made("os");
  return made;
}

LocalizerOptions withRadius(double radius_px) {
  LocalizerOptions options;
  options.refinement.last_radius_px = radius_px;
  return options;
}

LocalizationTrace runOf(const RunPlan& plan) {
  return localize(example().problem(), plan, RecordLevel::kFull);
}

TEST(RunPlan, GoesOnWithOtherOptions) {
  const RunPlan plain = withRadius(1.0);
  const RunPlan once = continuedPlan(plain, 3, withRadius(2.0));
  ASSERT_EQ(once.changes.size(), 1u);
  EXPECT_EQ(once.changes[0].iteration, 3);
  const RunPlan twice = continuedPlan(once, 5, withRadius(3.0));
  EXPECT_EQ(twice.changes.size(), 2u);
  EXPECT_EQ(twice.last().refinement.last_radius_px, 3.0);
  // An earlier iteration drops what came after it.
  const RunPlan earlier = continuedPlan(twice, 2, withRadius(4.0));
  ASSERT_EQ(earlier.changes.size(), 1u);
  EXPECT_EQ(earlier.changes[0].iteration, 2);
  // What holds there anyway is no change.
  EXPECT_THAT(continuedPlan(plain, 2, withRadius(1.0)).changes, IsEmpty());
  EXPECT_THAT(continuedPlan(twice, 3, withRadius(1.0)).changes, IsEmpty());
  EXPECT_EQ(continuedPlan(twice, 6, withRadius(3.0)).changes.size(), 2u);
  // From the first iteration on it is a new run.
  EXPECT_THAT(continuedPlan(twice, 0, withRadius(9.0)).changes, IsEmpty());
  EXPECT_EQ(continuedPlan(twice, 0, withRadius(9.0)).options.refinement.last_radius_px, 9.0);
}

TEST(RunPlan, SaysWhyItCannotBeRun) {
  LocalizerOptions fixed;
  fixed.templates.count += 1;
  EXPECT_EQ(planProblem(RunPlan(fixed)), "");
  EXPECT_THAT(planProblem({LocalizerOptions(), {{2, fixed}}}),
              HasSubstr("templates.count holds for a whole run"));
  EXPECT_THAT(planProblem({LocalizerOptions(), {{0, withRadius(2.0)}}}), HasSubstr("iteration 0"));
  EXPECT_THAT(planProblem({LocalizerOptions(), {{3, withRadius(2.0)}, {3, withRadius(1.0)}}}),
              HasSubstr("iteration 3"));
  EXPECT_THAT(planProblem({LocalizerOptions(), {{3, withRadius(-2.0)}}}),
              HasSubstr("refinement.last_radius_px is out of its range"));
  EXPECT_EQ(planProblem({LocalizerOptions(), {{3, withRadius(2.0)}, {4, withRadius(1.0)}}}), "");
}

TEST(RunPlan, TheSameOptionsGiveTheSameDigest) {
  const std::string plain = runOf(LocalizerOptions()).digest;
  for (const std::int32_t iteration : {1, 2, 3}) {
    EXPECT_EQ(runOf(continuedPlan(LocalizerOptions(), iteration, LocalizerOptions())).digest,
              plain);
    // Also when the change is made although it changes nothing.
    EXPECT_EQ(runOf({LocalizerOptions(), {{iteration, LocalizerOptions()}}}).digest, plain);
  }
}

TEST(RunPlan, KeepsTheFirstIterationsAndChangesTheOthers) {
  const LocalizationTrace plain = runOf(LocalizerOptions());
  const RunPlan plan = continuedPlan(LocalizerOptions(), 3, withRadius(5.0));
  const LocalizationTrace rerun = runOf(plan);
  ASSERT_GT(plain.iterations.size(), 3u);
  ASSERT_GT(rerun.iterations.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(rerun.iterations[i]->camera_from_station.translation_m,
              plain.iterations[i]->camera_from_station.translation_m);
  EXPECT_EQ(rerun.iterations[3]->threshold_px, 5.0 * (1 << rerun.iterations[3]->level));
  EXPECT_NE(rerun.iterations[3]->threshold_px, plain.iterations[3]->threshold_px);
  EXPECT_NE(rerun.digest, plain.digest);
  EXPECT_EQ(rerun.lastOptions().refinement.last_radius_px, 5.0);
}

TEST(RunPlan, HoweverItIsRunTheDigestIsTheSame) {
  const RunPlan plan = continuedPlan(LocalizerOptions(), 2, withRadius(5.0));
  const std::string whole = runOf(plan).digest;
  RunSettings settings;
  settings.level = RecordLevel::kSummary;
  settings.threads = 3;
  settings.kernels = Kernels::kPortable;
  EXPECT_EQ(localize(example().problem(), plan, settings).digest, whole);
  for (const StepUntil until : {StepUntil::kStage, StepUntil::kIteration, StepUntil::kEnd}) {
    Runner run(example().problem(), plan);
    while (!run.finished()) run.advance(until);
    EXPECT_EQ(run.trace().digest, whole);
    EXPECT_EQ(run.trace().complete(), run.trace().iterations.size());
  }
}

TEST(RunPlan, OneThatCannotBeRunIsAFault) {
  LocalizerOptions fixed;
  fixed.templates.count += 1;
  const RunPlan plan(LocalizerOptions(), {{2, fixed}});
  EXPECT_EQ(runOf(plan).fault, Status::kInvalidOption);
  const Runner run(example().problem(), plan);
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.trace().fault, Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight::sessions
