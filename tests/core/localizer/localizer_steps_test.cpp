// SPDX-License-Identifier: Apache-2.0
// The reports of `step()`.
#include <numeric>
#include <thread>
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
  switch (before) {
    case Stage::kEdges:
      return next == Stage::kRender || next == Stage::kSearch;
    case Stage::kSearch:
      return next == Stage::kRender;
    case Stage::kRender:
      return next == Stage::kTemplates || next == Stage::kRefine;
    case Stage::kTemplates:
      return next == Stage::kMatch;
    case Stage::kMatch:
      return next == Stage::kPose;
    case Stage::kPose:
    case Stage::kRefine:
      return next == Stage::kRender || next == Stage::kSupport;
    case Stage::kSupport:  // of a pose, then another pose, or of competing poses
      return next == Stage::kRender || next == Stage::kSupport || next == Stage::kFinished;
    case Stage::kFinished:
      return next == Stage::kFinished;
  }
  return false;
}

TEST(LocalizerSteps, StagesComeInOrder) {
  for (const bool paper : {false, true}) {
    const Case scene = stationCase(2);
    OwnedRun run(scene.problem(), paper ? paperProfile() : defaultProfile());
    Stage stage = Stage::kEdges;
    bool stage_complete = false;
    run.finish([&](const StepReport& report) {
      if (stage_complete) {
        EXPECT_TRUE(mayFollow(stage, report.stage))
            << stageText(stage) << " -> " << stageText(report.stage);
      } else {
        EXPECT_EQ(report.stage, stage) << stageText(report.stage);
      }
      stage = report.stage;
      stage_complete = report.stage_complete;
      EXPECT_EQ(run.localizer.workspace().status == LocalizationStatus::kRunning, !report.finished);
    });
    const bool converged = run.localizer.workspace().status == LocalizationStatus::kConverged;
    EXPECT_EQ(stage, converged ? Stage::kSupport : Stage::kPose);
    EXPECT_TRUE(converged || paper);
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

TEST(LocalizerSteps, StepAfterTheEnd_DoesNothing) {
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
  Pose rendered;
  int match = 0, templates = 0;
  int refine = 0, rounds_at_least = 0;
  run.finish([&](const StepReport& report) {
    const Workspace& workspace = run.localizer.workspace();
    edges += report.stage == Stage::kEdges ? 1 : 0;
    render += report.stage == Stage::kRender ? 1 : 0;
    match += report.stage == Stage::kMatch ? 1 : 0;
    refine += report.stage == Stage::kRefine ? 1 : 0;
    if (!report.stage_complete) return;
    if (report.stage == Stage::kRender) {  // a render that is kept takes no slices
      const Pose& from = workspace.iteration->render.camera_from_station;
      renders += from != rendered ? 1 : 0;
      rendered = from;
    }
    if (report.stage == Stage::kTemplates) templates += workspace.iteration->templates.count;
    if (report.stage == Stage::kRefine) rounds_at_least += 2;
  });
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

// Stages run by several workers: the same bits for any assignment and order of tasks.

/// A run with scratch for some workers.
struct SharedRun {
  std::vector<std::byte> memory;
  Localizer localizer;

  SharedRun(const LocalizationProblem& problem, const LocalizerOptions& options, int workers)
      : memory(bytesFor(problem, options, workers)), localizer(problem, options, memory, workers) {}
  static std::size_t bytesFor(const LocalizationProblem& problem, const LocalizerOptions& options,
                              int workers) {
    std::size_t bytes = 0;
    EXPECT_EQ(requiredBytes(sizeOf(problem), options, workers, bytes), Status::kOk);
    return bytes;
  }
};

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
    OwnedRun plain(scene.problem(), options);
    plain.finish();
    for (const std::uint32_t share : {100u, 50u, 3u}) {
      SharedRun run(scene.problem(), options, 3);
      Random random(share);
      bool rendered = false;
      bool matched = false;
      bool refined = false;
      StepReport report;
      while (!report.finished) {
        for (const int task : shuffled(run.localizer.tasks(), random)) {
          if (random.below(100) >= share) continue;
          run.localizer.runTask(task, static_cast<int>(random.below(3)));
        }
        const bool had_tasks = run.localizer.tasks() > 0;
        report = run.localizer.step();
        rendered = rendered || (had_tasks && report.stage == Stage::kRender);
        matched = matched || (had_tasks && report.stage == Stage::kMatch);
        refined = refined || (had_tasks && report.stage == Stage::kRefine);
      }
      EXPECT_TRUE(rendered);
      EXPECT_TRUE(matched);
      EXPECT_EQ(refined, !paper);
      EXPECT_EQ(run.localizer.digest(), plain.localizer.digest()) << share;
      EXPECT_EQ(run.localizer.tasks(), 0);
    }
  }
}

TEST(LocalizerTasks, ParallelThreads_GiveTheSameBits) {
  const Case scene = stationCase(6);
  OwnedRun plain(scene.problem(), defaultProfile());
  plain.finish();
  for (const int workers : {2, 3, 8}) {
    SharedRun run(scene.problem(), defaultProfile(), workers);
    do {
      const int tasks = run.localizer.tasks();
      std::vector<std::jthread> threads;
      for (int worker = 0; worker < workers && tasks > 0; ++worker) {
        threads.emplace_back([&run, tasks, worker, workers] {
          for (int task = worker; task < tasks; task += workers)
            run.localizer.runTask(task, worker);
        });
      }
    } while (!run.localizer.step().finished);
    EXPECT_EQ(run.localizer.digest(), plain.localizer.digest()) << workers;
  }
}

/// A fault during a shared render whose tasks are all left to step().
TEST(LocalizerTasks, SharedTasks_GiveTheSameFaults) {
  const Case scene = stationCase(4);
  LocalizerOptions options = defaultProfile();
  options.render.max_edge_pixels = 1000;
  OwnedRun plain(scene.problem(), options);
  plain.finish();
  ASSERT_EQ(plain.localizer.workspace().fault, Status::kCapacityExceeded);
  for (const int workers : {2, 3}) {
    SharedRun run(scene.problem(), options, workers);
    while (!run.localizer.step().finished) {
    }
    EXPECT_EQ(run.localizer.workspace().fault, Status::kCapacityExceeded);
    EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kFault);
    EXPECT_EQ(run.localizer.digest(), plain.localizer.digest());
  }
}

TEST(LocalizerTasks, StepAfterAllTasks_CompletesTheStage) {
  const Case scene = stationCase(4);
  SharedRun run(scene.problem(), withoutSearch(), 1);
  EXPECT_EQ(run.localizer.tasks(), 0);
  while (run.localizer.tasks() == 0) ASSERT_FALSE(run.localizer.step().finished);
  EXPECT_EQ(run.localizer.tasks(), run.localizer.workspace().iteration->templates.count);
  for (int task = 0; task < run.localizer.tasks(); ++task) run.localizer.runTask(task, 0);
  const StepReport report = run.localizer.step();
  EXPECT_EQ(report.stage, Stage::kMatch);
  EXPECT_TRUE(report.stage_complete);
}

TEST(LocalizerTasks, TasksOutOfRange_DoNothing) {
  const Case scene = stationCase(4);
  OwnedRun plain(scene.problem(), defaultProfile());
  plain.finish();
  SharedRun run(scene.problem(), defaultProfile(), 2);
  do {
    const int tasks = run.localizer.tasks();
    run.localizer.runTask(-1, 0);
    run.localizer.runTask(tasks, 0);
    run.localizer.runTask(0, -1);
    run.localizer.runTask(0, 2);
  } while (!run.localizer.step().finished);
  EXPECT_EQ(run.localizer.digest(), plain.localizer.digest());
}

TEST(LocalizerTasks, MoreWorkers_NeedMoreMemory) {
  const Case scene = stationCase(1);
  const ProblemSize size = sizeOf(scene.problem());
  std::size_t bytes_of_one = 0;
  std::size_t bytes_of_two = 0;
  std::size_t many = 0;
  ASSERT_EQ(requiredBytes(size, {}, bytes_of_one), Status::kOk);
  ASSERT_EQ(requiredBytes(size, {}, 2, bytes_of_two), Status::kOk);
  ASSERT_EQ(requiredBytes(size, {}, 64, many), Status::kOk);
  EXPECT_LT(bytes_of_one, bytes_of_two);
  EXPECT_LT(bytes_of_two, many);
  for (const int workers : {-1, 0, Localizer::kMaxWorkers + 1}) {
    EXPECT_EQ(requiredBytes(size, {}, workers, many), Status::kInvalidOption);
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
