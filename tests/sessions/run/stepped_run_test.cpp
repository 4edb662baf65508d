// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/stepped_run.h"

#include <gtest/gtest.h>

#include "sessions/run/record.h"
#include "tests/support/example_case.h"

namespace boresight::sessions {
namespace {

const test::ExampleCase& example() {
  static const test::ExampleCase made("os");
  return made;
}

const LocalizationTrace& wholeRun() {
  static const LocalizationTrace made =
      localize(example().problem(), defaultProfile(), RecordLevel::kFull);
  return made;
}

TEST(SteppedRun, HaltingChangesNoBit) {
  for (const StepUntil until : {StepUntil::kStage, StepUntil::kIteration, StepUntil::kEnd}) {
    SteppedRun run(example().problem(), defaultProfile());
    int halts = 0;
    while (!run.finished() && halts < 10000) {
      run.advance(until);
      ++halts;
    }
    EXPECT_EQ(run.snapshot().digest, wholeRun().digest);
    EXPECT_EQ(run.snapshot().iterations.size(), wholeRun().iterations.size());
    if (until == StepUntil::kEnd) {
      EXPECT_EQ(halts, 1);
    } else {
      EXPECT_GT(halts, 3);
    }
  }
}

TEST(SteppedRun, StopsBetweenSlicesAndGoesOn) {
  SteppedRun run(example().problem(), defaultProfile());
  std::stop_source stopped;
  stopped.request_stop();
  run.advance(StepUntil::kEnd, stopped.get_token());
  EXPECT_FALSE(run.finished());
  EXPECT_TRUE(run.snapshot().iterations.empty());
  run.advance(StepUntil::kEnd);
  EXPECT_EQ(run.snapshot().digest, wholeRun().digest);
}

TEST(SteppedRun, ShowsEachStageOfTheIterationUnderWay) {
  SteppedRun run(example().problem(), defaultProfile());
  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.snapshot().stage, Stage::kEdges);
  ASSERT_NE(run.snapshot().edges, nullptr);
  EXPECT_TRUE(run.snapshot().iterations.empty());

  run.advance(StepUntil::kStage);
  ASSERT_EQ(run.snapshot().iterations.size(), 1u);
  EXPECT_TRUE(run.snapshot().last_under_way);
  EXPECT_EQ(run.snapshot().iterations[0]->reached, Stage::kRender);
  EXPECT_GT(run.snapshot().iterations[0]->edge_pixel_count, 100);
  EXPECT_TRUE(run.snapshot().iterations[0]->templates.empty());

  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.snapshot().iterations[0]->reached, Stage::kTemplates);
  EXPECT_GT(run.snapshot().iterations[0]->template_count, 6);

  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.snapshot().iterations[0]->reached, Stage::kMatch);
  EXPECT_EQ(run.snapshot().iterations[0]->matches.size(),
            run.snapshot().iterations[0]->templates.size());

  run.advance(StepUntil::kStage);
  EXPECT_EQ(run.snapshot().iterations[0]->reached, Stage::kPose);
  EXPECT_FALSE(run.snapshot().iterations[0]->pnp.inlier.empty());
}

TEST(SteppedRun, ASnapshotStaysWhatItWas) {
  SteppedRun run(example().problem(), defaultProfile());
  run.advance(StepUntil::kIteration);
  const RunSnapshot before = run.snapshot();
  const auto first = before.iterations.at(0);
  const std::int32_t inliers = first->pnp.inlier_count;
  run.advance(StepUntil::kEnd);
  EXPECT_EQ(before.iterations.size(), 1u);
  EXPECT_EQ(first->pnp.inlier_count, inliers);
  EXPECT_EQ(run.snapshot().iterations.at(0), first) << "shared, not copied";
}

TEST(SteppedRun, AProblemThatCannotRunIsFinishedWithAFault) {
  LocalizationProblem problem = example().problem();
  problem.mesh.faces = {};
  SteppedRun run(problem, defaultProfile());
  run.advance(StepUntil::kEnd);
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.snapshot().status, LocalizationStatus::kFault);
  EXPECT_EQ(run.snapshot().fault, Status::kInvalidMesh);
}

TEST(RunSnapshot, ATraceComesBackAsItWas) {
  LocalizationTrace copy = wholeRun();
  const RunSnapshot snapshot = snapshotOf(std::move(copy));
  EXPECT_TRUE(snapshot.finished);
  const LocalizationTrace back = traceOf(snapshot);
  EXPECT_EQ(back.digest, wholeRun().digest);
  EXPECT_EQ(back.iterations.size(), wholeRun().iterations.size());
  EXPECT_EQ(back.edges.edge_count, wholeRun().edges.edge_count);
  EXPECT_EQ(back.support.covered, wholeRun().support.covered);
  EXPECT_EQ(back.arena_bytes, wholeRun().arena_bytes);
}

}  // namespace
}  // namespace boresight::sessions
