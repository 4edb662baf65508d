// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_plan.h"

#include <gtest/gtest.h>

#include "sessions/run/runner.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

LocalizerOptions withRenderAgain(double render_again_px) {
  LocalizerOptions options;
  options.loop.render_again_px = render_again_px;
  return options;
}

LocalizationTrace runOf(const RunPlan& plan) {
  return localize(test::osExample().problem(), plan, RecordLevel::kFull);
}

/// By the default profile of runs, once per program.
const LocalizationTrace& plainRun() {
  static const LocalizationTrace run = runOf(LocalizerOptions());
  return run;
}

TEST(RunPlan, GoesOnWithOtherOptions) {
  const RunPlan plain = withRenderAgain(1.0);
  const RunPlan once = continuedPlan(plain, 3, withRenderAgain(2.0));
  ASSERT_EQ(once.changes.size(), 1u);
  EXPECT_EQ(once.changes[0].iteration, 3);
  const RunPlan twice = continuedPlan(once, 5, withRenderAgain(3.0));
  EXPECT_EQ(twice.changes.size(), 2u);
  EXPECT_EQ(twice.last().loop.render_again_px, 3.0);
  // An earlier iteration drops what came after it.
  const RunPlan earlier = continuedPlan(twice, 2, withRenderAgain(4.0));
  ASSERT_EQ(earlier.changes.size(), 1u);
  EXPECT_EQ(earlier.changes[0].iteration, 2);
  // What holds there anyway is no change.
  EXPECT_THAT(continuedPlan(plain, 2, withRenderAgain(1.0)).changes, IsEmpty());
  EXPECT_THAT(continuedPlan(twice, 3, withRenderAgain(1.0)).changes, IsEmpty());
  EXPECT_EQ(continuedPlan(twice, 6, withRenderAgain(3.0)).changes.size(), 2u);
  // From the first iteration on it is a new run.
  EXPECT_THAT(continuedPlan(twice, 0, withRenderAgain(9.0)).changes, IsEmpty());
  EXPECT_EQ(continuedPlan(twice, 0, withRenderAgain(9.0)).options.loop.render_again_px, 9.0);
}

TEST(RunPlan, SaysWhyItCannotBeRun) {
  LocalizerOptions fixed;
  fixed.templates.count += 1;
  EXPECT_EQ(planProblem(RunPlan(fixed)), "");
  const auto problemOf = [](const std::vector<OptionChange>& changes) {
    return planProblem({LocalizerOptions(), changes});
  };
  EXPECT_THAT(problemOf({{2, fixed}}), HasSubstr("templates.count cannot change during a run"));
  EXPECT_THAT(problemOf({{0, withRenderAgain(2.0)}}), HasSubstr("iteration 0"));
  EXPECT_THAT(problemOf({{3, withRenderAgain(2.0)}, {3, withRenderAgain(1.0)}}),
              HasSubstr("iteration 3"));
  EXPECT_THAT(problemOf({{3, withRenderAgain(-2.0)}}),
              HasSubstr("loop.render_again_px is out of its range"));
  EXPECT_EQ(problemOf({{3, withRenderAgain(2.0)}, {4, withRenderAgain(1.0)}}), "");
  const LocalizationTrace refused = runOf({LocalizerOptions(), {{2, fixed}}});
  EXPECT_TRUE(refused.finished);
  EXPECT_EQ(refused.fault, Status::kInvalidOption);
}

/// A change is made although it changes nothing.
TEST(RunPlan, TheSameOptionsGiveTheSameDigest) {
  EXPECT_THAT(continuedPlan(LocalizerOptions(), 2, LocalizerOptions()).changes, IsEmpty());
  for (const std::int32_t iteration : {1, 2, 3})
    EXPECT_EQ(runOf({LocalizerOptions(), {{iteration, LocalizerOptions()}}}).digest,
              plainRun().digest);
}

TEST(RunPlan, KeepsTheFirstIterationsAndChangesTheOthers) {
  LocalizerOptions longer;
  longer.loop.converged_iterations = 4;
  longer.loop.converged_image_px = 0.0;  // until the metric limits hold four times
  longer.loop.converged_translation_m = 1e-9;
  const LocalizationTrace rerun = runOf(continuedPlan(LocalizerOptions(), 3, longer));
  ASSERT_GT(plainRun().iterations.size(), 3u);
  ASSERT_GT(rerun.iterations.size(), plainRun().iterations.size());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(rerun.iterations[i]->camera_from_station.translation_m,
              plainRun().iterations[i]->camera_from_station.translation_m);
  EXPECT_NE(rerun.digest, plainRun().digest);
  EXPECT_EQ(rerun.lastOptions().loop.converged_iterations, 4);
}

TEST(RunPlan, HoweverItIsRunTheDigestIsTheSame) {
  const RunPlan plan = continuedPlan(LocalizerOptions(), 2, withRenderAgain(5.0));
  const std::string whole = runOf(plan).digest;
  RunSettings settings;
  settings.level = RecordLevel::kSummary;
  settings.threads = 3;
  settings.kernels = Kernels::kPortable;
  EXPECT_EQ(localize(test::osExample().problem(), plan, settings).digest, whole);
  Runner run(test::osExample().problem(), plan);
  while (!run.finished()) run.advance(StepUntil::kStage);
  EXPECT_EQ(run.trace().digest, whole);
  EXPECT_EQ(run.trace().complete(), run.trace().iterations.size());
}

}  // namespace
}  // namespace boresight::sessions
