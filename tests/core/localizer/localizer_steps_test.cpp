// SPDX-License-Identifier: Apache-2.0
// What `step()` says of itself.
#include <gtest/gtest.h>

#include "core/edges/edge_input.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// Stages that may follow a completed one.
bool mayFollow(Stage before, Stage now) {
  switch (before) {
    case Stage::kEdges:
      return now == Stage::kRender || now == Stage::kSearch;
    case Stage::kSearch:
      return now == Stage::kRender;
    case Stage::kRender:
      return now == Stage::kTemplates || now == Stage::kRefine;
    case Stage::kTemplates:
      return now == Stage::kMatch;
    case Stage::kMatch:
      return now == Stage::kPose;
    case Stage::kPose:
    case Stage::kRefine:
      return now == Stage::kRender || now == Stage::kSupport;
    case Stage::kSupport:
    case Stage::kFinished:
      return now == Stage::kFinished;
  }
  return false;
}

TEST(LocalizerSteps, StagesComeInOrder) {
  for (const bool paper : {false, true}) {
    const Case scene = stationCase(2);
    OwnedRun run(scene.problem(), paper ? paperProfile() : defaultProfile());
    Stage stage = Stage::kEdges;
    bool stage_complete = false;
    StepReport report;
    while (!report.finished) {
      report = run.localizer.step();
      if (stage_complete) {
        EXPECT_TRUE(mayFollow(stage, report.stage))
            << stageText(stage) << " -> " << stageText(report.stage);
      } else {
        EXPECT_EQ(report.stage, stage) << stageText(report.stage);
      }
      stage = report.stage;
      stage_complete = report.stage_complete;
      EXPECT_EQ(run.localizer.workspace().status == LocalizationStatus::kRunning, !report.finished);
    }
    EXPECT_EQ(stage, Stage::kSupport);
    EXPECT_TRUE(stage_complete);
  }
}

/// Counts what is reported; the numbers of the iterations must run on.
struct Tally {
  int complete = 0;
  int at_support = 0;
  int steps = 0;
  LocalizationStatus last = LocalizationStatus::kRunning;

  explicit Tally(Localizer& localizer) {
    StepReport report;
    while (!report.finished && steps < 100000) {
      report = localizer.step();
      ++steps;
      if (!report.iteration_complete) continue;
      const Iteration* iteration = localizer.workspace().iteration;
      EXPECT_NE(iteration, nullptr);
      if (iteration == nullptr) break;
      EXPECT_EQ(iteration->index, complete);
      EXPECT_TRUE(report.stage_complete);
      ++complete;
      at_support += report.stage == Stage::kSupport ? 1 : 0;
      last = iteration->status;
    }
  }
};

TEST(LocalizerSteps, EachIterationIsCompleteOnce) {
  const Case scene = stationCase(2);
  for (const bool paper : {false, true}) {
    OwnedRun run(scene.problem(), paper ? paperProfile() : withoutSearch());
    const Tally tally(run.localizer);
    EXPECT_EQ(tally.complete, run.localizer.workspace().iterations);
    EXPECT_GE(tally.complete, 4);
  }
}

TEST(LocalizerSteps, EachIterationOfAFailedRunIsCompleteOnce) {
  const Case scene = stationCase(2);
  const Picture faint_picture = faintened(*scene.picture);
  Case faint = scene;
  faint.picture = &faint_picture;
  LocalizerOptions options[4];
  for (LocalizerOptions& each : options) each.search.enabled = false;
  options[0].loop.max_iterations = 2;
  options[1].support.min_support = 0.99;
  options[2].loop.max_rolled_hypotheses = 1;
  options[3].templates.count = 4;  // fewer than a run needs
  const LocalizationStatus ends[] = {
      LocalizationStatus::kIterationLimit, LocalizationStatus::kNotSupported,
      LocalizationStatus::kPnpFailed, LocalizationStatus::kTooFewTemplates};
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(localizationStatusText(ends[i]));
    OwnedRun run(i == 2 ? faint.problem() : scene.problem(), options[i]);
    const Tally tally(run.localizer);
    EXPECT_EQ(tally.complete, run.localizer.workspace().iterations);
    EXPECT_EQ(tally.at_support, 0);
    EXPECT_EQ(run.localizer.workspace().status, ends[i]);
    EXPECT_EQ(run.localizer.workspace().iteration->status, ends[i]);
    EXPECT_EQ(run.localizer.workspace().attempts, 3);
  }
}

TEST(LocalizerSteps, NothingHappensAfterTheEnd) {
  const Case scene = stationCase(2);
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish();
  const auto digest = run.localizer.digest();
  for (int i = 0; i < 3; ++i) {
    const StepReport report = run.localizer.step();
    EXPECT_TRUE(report.finished);
    EXPECT_EQ(report.stage, Stage::kFinished);
    EXPECT_FALSE(report.iteration_complete);
    EXPECT_FALSE(report.stage_complete);
  }
  EXPECT_EQ(run.localizer.digest(), digest);
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kConverged);
}

TEST(LocalizerSteps, SlicesAreSmall) {
  const Case scene = stationCase(2);
  OwnedRun run(scene.problem(), defaultProfile());
  int edges = 0;
  int render = 0, renders = 0;
  int match = 0, templates = 0;
  int refine = 0, rounds_at_least = 0;
  StepReport report;
  while (!report.finished) {
    report = run.localizer.step();
    const Workspace& workspace = run.localizer.workspace();
    edges += report.stage == Stage::kEdges ? 1 : 0;
    render += report.stage == Stage::kRender ? 1 : 0;
    match += report.stage == Stage::kMatch ? 1 : 0;
    refine += report.stage == Stage::kRefine ? 1 : 0;
    if (!report.stage_complete) continue;
    if (report.stage == Stage::kRender) ++renders;
    if (report.stage == Stage::kTemplates) templates += workspace.iteration->templates.count;
    if (report.stage == Stage::kRefine) rounds_at_least += 2;
  }
  EXPECT_GE(edges, 5 * 512 * 512 / kEdgeSlice);  // as many as passes over the pixels
  EXPECT_GE(render, renders * 512 / EdgeRenderer::kBandRows / 2);  // the station fills half
  EXPECT_GE(match, templates);         // a template is at least one step
  EXPECT_GE(refine, rounds_at_least);  // a round is one step
}

TEST(LocalizerSteps, TextsAreDistinct) {
  for (int a = 0; a <= static_cast<int>(Stage::kFinished); ++a) {
    EXPECT_STRNE(stageText(static_cast<Stage>(a)), "unknown");
    for (int b = 0; b < a; ++b)
      EXPECT_STRNE(stageText(static_cast<Stage>(a)), stageText(static_cast<Stage>(b)));
  }
  for (int a = 0; a <= static_cast<int>(LocalizationStatus::kFault); ++a) {
    EXPECT_STRNE(localizationStatusText(static_cast<LocalizationStatus>(a)), "unknown");
    for (int b = 0; b < a; ++b) {
      EXPECT_STRNE(localizationStatusText(static_cast<LocalizationStatus>(a)),
                   localizationStatusText(static_cast<LocalizationStatus>(b)));
    }
  }
}

}  // namespace
}  // namespace boresight::test
