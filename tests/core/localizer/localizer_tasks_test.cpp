// SPDX-License-Identifier: Apache-2.0
// Stages shared out among workers: the same bits whoever does what, and in which order.
#include <algorithm>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

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

TEST(LocalizerPieces, MayBeDoneInAnyOrderByAnyWorkerOrNotAtAll) {
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
        for (const int piece : shuffled(run.localizer.tasks(), random)) {
          if (random.below(100) >= share) continue;
          run.localizer.runTask(piece, static_cast<int>(random.below(3)));
        }
        const bool had_pieces = run.localizer.tasks() > 0;
        report = run.localizer.step();
        rendered = rendered || (had_pieces && report.stage == Stage::kRender);
        matched = matched || (had_pieces && report.stage == Stage::kMatch);
        refined = refined || (had_pieces && report.stage == Stage::kRefine);
      }
      EXPECT_TRUE(rendered);
      EXPECT_TRUE(matched);
      EXPECT_EQ(refined, !paper);
      EXPECT_EQ(run.localizer.digest(), plain.localizer.digest()) << share;
      EXPECT_EQ(run.localizer.tasks(), 0);
    }
  }
}

TEST(LocalizerPieces, MayBeDoneAtTheSameTime) {
  const Case scene = stationCase(6);
  OwnedRun plain(scene.problem(), defaultProfile());
  plain.finish();
  for (const int workers : {2, 3, 8}) {
    SharedRun run(scene.problem(), defaultProfile(), workers);
    do {
      const int pieces = run.localizer.tasks();
      std::vector<std::jthread> threads;
      for (int worker = 0; worker < workers && pieces > 0; ++worker) {
        threads.emplace_back([&run, pieces, worker, workers] {
          for (int piece = worker; piece < pieces; piece += workers)
            run.localizer.runTask(piece, worker);
        });
      }
    } while (!run.localizer.step().finished);
    EXPECT_EQ(run.localizer.digest(), plain.localizer.digest()) << workers;
  }
}

/// A fault while the render is shared out, and nobody but step() to do the pieces.
TEST(LocalizerPieces, FaultsAreTheSame) {
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

TEST(LocalizerPieces, AreAStageOnceTheyAreDone) {
  const Case scene = stationCase(4);
  SharedRun run(scene.problem(), withoutSearch(), 1);
  EXPECT_EQ(run.localizer.tasks(), 0);
  while (run.localizer.tasks() == 0) ASSERT_FALSE(run.localizer.step().finished);
  EXPECT_EQ(run.localizer.tasks(), run.localizer.workspace().iteration->templates.count);
  for (int piece = 0; piece < run.localizer.tasks(); ++piece) run.localizer.runTask(piece, 0);
  const StepReport report = run.localizer.step();
  EXPECT_EQ(report.stage, Stage::kMatch);
  EXPECT_TRUE(report.stage_complete);
}

TEST(LocalizerPieces, ThatDoNotExistAreNotDone) {
  const Case scene = stationCase(4);
  OwnedRun plain(scene.problem(), defaultProfile());
  plain.finish();
  SharedRun run(scene.problem(), defaultProfile(), 2);
  do {
    const int pieces = run.localizer.tasks();
    run.localizer.runTask(-1, 0);
    run.localizer.runTask(pieces, 0);
    run.localizer.runTask(0, -1);
    run.localizer.runTask(0, 2);
  } while (!run.localizer.step().finished);
  EXPECT_EQ(run.localizer.digest(), plain.localizer.digest());
}

TEST(LocalizerPieces, WorkersNeedMemory) {
  const Case scene = stationCase(1);
  const ProblemSize size = sizeOf(scene.problem());
  std::size_t one = 0;
  std::size_t two = 0;
  std::size_t many = 0;
  ASSERT_EQ(requiredBytes(size, {}, one), Status::kOk);
  ASSERT_EQ(requiredBytes(size, {}, 2, two), Status::kOk);
  ASSERT_EQ(requiredBytes(size, {}, 64, many), Status::kOk);
  EXPECT_LT(one, two);
  EXPECT_LT(two, many);
  for (const int workers : {-1, 0, Localizer::kMaxWorkers + 1}) {
    EXPECT_EQ(requiredBytes(size, {}, workers, many), Status::kInvalidOption);
    std::vector<std::byte> memory(std::size_t{1} << 23);
    Localizer localizer(scene.problem(), {}, memory, workers);
    EXPECT_EQ(localizer.status(), Status::kInvalidOption);
    EXPECT_TRUE(localizer.step().finished);
  }
  std::vector<std::byte> memory(one);
  Localizer starved(scene.problem(), {}, memory, 2);
  EXPECT_EQ(starved.status(), Status::kArenaTooSmall);
}

}  // namespace
}  // namespace boresight::test
