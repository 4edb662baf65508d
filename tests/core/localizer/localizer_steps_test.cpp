// SPDX-License-Identifier: Apache-2.0
// The reports of `step()`.
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/edges/edge_map.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// Stages that may follow a completed one.
bool mayFollow(Stage before, Stage next) {
  static const std::map<Stage, std::set<Stage>> followers = {
      {Stage::kEdges, {Stage::kRender, Stage::kSearch}},
      {Stage::kSearch, {Stage::kRender}},
      {Stage::kRender, {Stage::kTemplates, Stage::kRefine}},
      {Stage::kTemplates, {Stage::kMatch}},
      {Stage::kMatch, {Stage::kPose}},
      {Stage::kPose, {Stage::kRender, Stage::kSupport}},
      {Stage::kRefine, {Stage::kRender, Stage::kSupport}},
      // Of a pose, then another pose, or of competing poses.
      {Stage::kSupport, {Stage::kRender, Stage::kSupport, Stage::kFinished}},
      {Stage::kFinished, {Stage::kFinished}}};
  return followers.at(before).contains(next);
}

/// Runs to the end, with `each` after every step: the numbers of completed iterations must run on.
template <class Each>
void finishCounting(OwnedRun& run, const Each& each) {
  int complete = 0;
  run.finish([&](const StepReport& report) {
    each(report);
    if (!report.iteration_complete) return;
    EXPECT_TRUE(report.stage_complete);
    ASSERT_NE(run.workspace.iteration, nullptr);
    EXPECT_EQ(run.workspace.iteration->index, complete++);
  });
  EXPECT_EQ(complete, run.workspace.iterations);
}

TEST(LocalizerSteps, StagesComeInOrderAndEachIterationIsCompleteOnce) {
  const Case scene = stationCase(2);
  for (const LocalizerOptions& options : {defaultProfile(), withoutSearch(), paperProfile()}) {
    OwnedRun run(scene.problem(), options);
    Stage stage = Stage::kEdges;
    bool stage_complete = false;
    finishCounting(run, [&](const StepReport& report) {
      EXPECT_TRUE(stage_complete ? mayFollow(stage, report.stage) : report.stage == stage)
          << stageText(stage) << " -> " << stageText(report.stage);
      stage = report.stage;
      stage_complete = report.stage_complete;
      EXPECT_EQ(run.workspace.status == LocalizationStatus::kRunning, !report.finished);
    });
    const LocalizationStatus status = run.workspace.status;
    const bool converged = status == LocalizationStatus::kConverged;
    EXPECT_EQ(stage, converged ? Stage::kSupport : Stage::kPose);
    EXPECT_TRUE(converged || !options.refinement.enabled) << "only the paper's may fail";
    EXPECT_TRUE(stage_complete);
    EXPECT_GE(run.workspace.iterations, options.search.enabled ? 3 : 4);

    const Digest digest = run.localizer.digest();
    for (int i = 0; i < 3; ++i) {
      const StepReport after = run.localizer.step();
      EXPECT_TRUE(after.finished);
      EXPECT_EQ(after.stage, Stage::kFinished);
      EXPECT_FALSE(after.iteration_complete || after.stage_complete);
    }
    EXPECT_EQ(run.localizer.digest(), digest) << "a step after the end does nothing";
    EXPECT_EQ(run.workspace.status, status);
  }
}

TEST(LocalizerSteps, EachIterationOfAFailedRunIsCompleteOnce) {
  Case scene = stationCase(2);
  const Picture sharp = *scene.picture;
  const Picture faint = faintened(sharp);
  LocalizerOptions few_iterations = withoutSearch();
  few_iterations.loop.max_iterations = 2;
  LocalizerOptions strict = withoutSearch();
  strict.support.min_support = 0.99;
  LocalizerOptions unrolled = withoutSearch();
  unrolled.loop.max_rolled_hypotheses = 1;
  LocalizerOptions few_templates = withoutSearch();
  few_templates.templates.count = 4;  // fewer than a run needs
  const struct {
    const Picture& picture;
    const LocalizerOptions& options;
    LocalizationStatus end;
  } runs[] = {{sharp, few_iterations, LocalizationStatus::kIterationLimit},
              {sharp, strict, LocalizationStatus::kNotSupported},
              {faint, unrolled, LocalizationStatus::kPnpFailed},
              {sharp, few_templates, LocalizationStatus::kTooFewTemplates}};
  for (const auto& [picture, options, end] : runs) {
    SCOPED_TRACE(localizationStatusText(end));
    scene.picture = &picture;
    OwnedRun run(scene.problem(), options);
    finishCounting(run, [](const StepReport& report) {
      EXPECT_FALSE(report.iteration_complete && report.stage == Stage::kSupport);
    });
    EXPECT_EQ(run.workspace.status, end);
    EXPECT_EQ(run.workspace.iteration->status, end);
    EXPECT_EQ(run.workspace.attempts, 3);
  }
}

TEST(LocalizerSteps, SlicesAreSmall) {
  const Case scene = stationCase(2);
  OwnedRun run(scene.problem(), defaultProfile());
  std::map<Stage, int> slices;
  int renders = 0, templates = 0, refinements = 0;
  Pose rendered;
  run.finish([&](const StepReport& report) {
    ++slices[report.stage];
    if (!report.stage_complete) return;
    if (report.stage == Stage::kRender) {  // a render that is kept takes no slices
      const Pose& from = run.workspace.iteration->render.camera_from_station;
      renders += from != rendered ? 1 : 0;
      rendered = from;
    }
    if (report.stage == Stage::kTemplates) templates += run.workspace.iteration->templates.count;
    if (report.stage == Stage::kRefine) ++refinements;
  });
  EXPECT_GE(slices[Stage::kEdges], 5 * 512 * 512 / kEdgeSlice);  // as many as passes over pixels
  // The station fills half of the image.
  EXPECT_GE(slices[Stage::kRender], renders * 512 / EdgeRenderer::kBandRows / 2);
  EXPECT_GE(slices[Stage::kMatch], templates);         // a template is at least one step
  EXPECT_GE(slices[Stage::kRefine], 2 * refinements);  // a round is one step
}

TEST(LocalizerSteps, TextsAreDistinct) {
  std::set<std::string_view> stages = {"unknown"};
  for (int stage = 0; stage <= static_cast<int>(Stage::kFinished); ++stage)
    EXPECT_TRUE(stages.insert(stageText(static_cast<Stage>(stage))).second) << stage;
  std::set<std::string_view> texts = {"unknown"};
  for (int status = 0; status <= static_cast<int>(kLastLocalizationStatus); ++status) {
    const char* text = localizationStatusText(static_cast<LocalizationStatus>(status));
    EXPECT_TRUE(texts.insert(text).second) << status;
  }
}

// Stages run by several workers: the same bits for any assignment and order of tasks.

std::vector<int> shuffled(int count, Random& random) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  return order;
}

TEST(LocalizerTasks, AnyOrderWorkerOrSubset_GivesTheSameBits) {
  const Case scene = stationCase(4, true);
  for (const bool paper : {false, true}) {
    const LocalizerOptions options = paper ? paperProfile() : withoutSearch();
    const Digest plain = digestOf(scene.problem(), options);
    for (const std::uint32_t share : {100u, 50u, 3u}) {
      OwnedRun run(scene.problem(), options, 3);
      Random random(share);
      std::set<Stage> shared;
      StepReport report;
      while (!report.finished) {
        for (const int task : shuffled(run.localizer.tasks(), random)) {
          if (random.below(100) >= share) continue;
          run.localizer.runTask(task, static_cast<int>(random.below(3)));
        }
        const bool had_tasks = run.localizer.tasks() > 0;
        report = run.localizer.step();
        if (had_tasks) shared.insert(report.stage);
      }
      EXPECT_TRUE(shared.contains(Stage::kRender));
      EXPECT_TRUE(shared.contains(Stage::kMatch));
      EXPECT_EQ(shared.contains(Stage::kRefine), !paper);
      EXPECT_EQ(run.localizer.digest(), plain) << share;
      EXPECT_EQ(run.localizer.tasks(), 0);
    }
  }
}

TEST(LocalizerTasks, ParallelThreads_GiveTheSameBits) {
  const Case scene = stationCase(6);
  const LocalizationProblem problem = scene.problem();
  const Digest plain = digestOf(problem, defaultProfile());
  for (const int workers : {2, 3, 8})
    EXPECT_EQ(sharedDigest(problem, defaultProfile(), workers, Kernels::kPortable), plain)
        << workers;
}

TEST(LocalizerTasks, StepAfterAllTasks_CompletesTheStage) {
  const Case scene = stationCase(4);
  OwnedRun run(scene.problem(), withoutSearch());
  EXPECT_EQ(run.localizer.tasks(), 0);
  while (run.localizer.tasks() == 0) ASSERT_FALSE(run.localizer.step().finished);
  EXPECT_EQ(run.localizer.tasks(), run.workspace.iteration->templates.count);
  for (int task = 0; task < run.localizer.tasks(); ++task) run.localizer.runTask(task, 0);
  const StepReport report = run.localizer.step();
  EXPECT_EQ(report.stage, Stage::kMatch);
  EXPECT_TRUE(report.stage_complete);
}

TEST(LocalizerTasks, TasksOutOfRange_DoNothing) {
  const Case scene = stationCase(4);
  OwnedRun run(scene.problem(), defaultProfile(), 2);
  do {
    const int tasks = run.localizer.tasks();
    for (const auto& [task, worker] : {std::pair{-1, 0}, {tasks, 0}, {0, -1}, {0, 2}})
      run.localizer.runTask(task, worker);
  } while (!run.localizer.step().finished);
  EXPECT_EQ(run.localizer.digest(), digestOf(scene.problem(), defaultProfile()));
}

TEST(LocalizerTasks, MoreWorkers_NeedMoreMemory) {
  const Case scene = stationCase(1);
  const ProblemSize size = sizeOf(scene.problem());
  const std::size_t bytes_of_one = blockFor(scene.problem(), {}).size();
  const std::size_t bytes_of_two = blockFor(scene.problem(), {}, 2).size();
  EXPECT_LT(bytes_of_one, bytes_of_two);
  EXPECT_LT(bytes_of_two, blockFor(scene.problem(), {}, 64).size());
  for (const int workers : {-1, 0, Localizer::kMaxWorkers + 1}) {
    std::size_t bytes = 0;
    EXPECT_EQ(requiredBytes(size, {}, workers, bytes), Status::kInvalidOption);
    std::vector<std::byte> memory(std::size_t{1} << 23);
    Localizer localizer(scene.problem(), {}, memory, workers);
    EXPECT_EQ(localizer.status(), Status::kInvalidOption);
    EXPECT_TRUE(localizer.step().finished);
  }
  std::vector<std::byte> memory(bytes_of_one);
  Localizer starved(scene.problem(), {}, memory, 2);
  EXPECT_EQ(starved.status(), Status::kArenaTooSmall);
}

}  // namespace
}  // namespace boresight::test
