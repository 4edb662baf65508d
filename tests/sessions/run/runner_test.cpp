// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/runner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

const LocalizationTrace& wholeRun() { return test::exampleTrace(); }

TEST(Runner, HaltingChangesNoBit) {
  for (const StepUntil until : {StepUntil::kStage, StepUntil::kIteration, StepUntil::kEnd}) {
    Runner run(test::osExample().problem(), defaultProfile());
    int halts = 0;
    for (; !run.finished() && halts < 10000; ++halts) run.advance(until);
    EXPECT_EQ(run.trace().digest, wholeRun().digest);
    EXPECT_EQ(run.trace().iterations.size(), wholeRun().iterations.size());
    if (until == StepUntil::kEnd) {
      EXPECT_EQ(halts, 1);
    } else {
      EXPECT_GT(halts, 3);
    }
  }
}

/// In the memory of another problem that needs more, and of one that was stopped on the way.
TEST(Runner, Restart_GivesTheDigestOfANewRun) {
  const test::ExampleCase other("bc");
  Runner run(other.problem(), defaultProfile());
  run.advance(StepUntil::kIteration);
  run.restart(test::osExample().problem());
  EXPECT_FALSE(run.finished());
  run.advance(StepUntil::kEnd);
  EXPECT_EQ(run.trace().digest, wholeRun().digest);
  EXPECT_EQ(run.trace().iterations.size(), wholeRun().iterations.size());
  LocalizationProblem wrong = test::osExample().problem();
  wrong.camera_from_station_seed.translation_m.x() = std::nan("");
  run.restart(wrong);
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.trace().fault, Status::kInvalidPose);
  run.restart(test::osExample().problem());
  run.advance(StepUntil::kEnd);
  EXPECT_EQ(run.trace().digest, wholeRun().digest);
}

TEST(Runner, StopsBetweenSlicesAndGoesOnWithoutChangingASnapshot) {
  Runner run(test::osExample().problem(), defaultProfile());
  std::stop_source stopped;
  stopped.request_stop();
  run.advance(StepUntil::kEnd, stopped.get_token());
  EXPECT_FALSE(run.finished());
  EXPECT_TRUE(run.trace().iterations.empty());
  run.advance(StepUntil::kIteration);
  const LocalizationTrace before = run.trace();
  const auto first = before.iterations.at(0);
  const std::int32_t inliers = first->pnp.inlier_count;
  run.advance(StepUntil::kEnd);
  EXPECT_EQ(run.trace().digest, wholeRun().digest);
  EXPECT_EQ(before.iterations.size(), 1u);
  EXPECT_EQ(first->pnp.inlier_count, inliers);
  EXPECT_EQ(run.trace().iterations.at(0), first) << "shared, not copied";
}

TEST(Runner, ShowsEachStageOfTheIterationUnderWay) {
  Runner run(test::osExample().problem(), defaultProfile(), {.level = RecordLevel::kStages});
  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.trace().stage, Stage::kEdges);
  ASSERT_NE(run.trace().edges, nullptr);
  EXPECT_TRUE(run.trace().iterations.empty());

  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.trace().stage, Stage::kSearch);
  EXPECT_FALSE(run.trace().candidates.empty());
  EXPECT_TRUE(run.trace().iterations.empty());

  const auto firstAfter = [&run](Stage stage) {
    run.advance(StepUntil::kStage);
    const auto first = run.trace().iterations.at(0);
    EXPECT_EQ(first->reached, stage);
    return first;
  };
  const auto rendered = firstAfter(Stage::kRender);
  EXPECT_TRUE(run.trace().last_under_way);
  EXPECT_GT(rendered->edge_pixel_count, 100);
  EXPECT_TRUE(rendered->templates.empty());
  EXPECT_GT(firstAfter(Stage::kTemplates)->template_count, 6);
  const auto matched = firstAfter(Stage::kMatch);
  EXPECT_EQ(matched->matches.size(), matched->templates.size());
  EXPECT_FALSE(firstAfter(Stage::kPose)->pnp.inlier.empty());
}

}  // namespace
}  // namespace boresight::sessions
