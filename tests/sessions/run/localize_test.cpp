// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/runner.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "tests/support/example_case.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// One run, recorded in full and in summary, shared by the tests below.
struct Runs {
  const test::ExampleCase& example = test::osExample();
  LocalizationTrace full = localize(example.problem(), defaultProfile(), RecordLevel::kFull);
  LocalizationTrace summary = localize(example.problem(), defaultProfile(), RecordLevel::kSummary);
};

const Runs& runs() {
  static const Runs result;
  return result;
}

TEST(Localize, EqualsAPlainLoopOfStepsHoweverMuchIsRecorded) {
  const LocalizationProblem problem = runs().example.problem();
  std::size_t bytes = 0;
  ASSERT_EQ(requiredBytes(sizeOf(problem), defaultProfile(), bytes), Status::kOk);
  std::vector<std::byte> memory(bytes);
  Localizer localizer(problem, defaultProfile(), memory);
  while (!localizer.step().finished) {
  }
  EXPECT_EQ(hexText(localizer.digest()).data(), runs().full.digest);
  EXPECT_EQ(runs().summary.digest, runs().full.digest);
  EXPECT_EQ(static_cast<std::size_t>(localizer.workspace().iterations),
            runs().full.iterations.size());
  ASSERT_EQ(runs().full.status, LocalizationStatus::kConverged);
  EXPECT_THAT(runs().full.camera_from_station,
              test::poseNear(runs().example.truth.camera_from_station, 2e-3, 1e-3));
}

TEST(Localize, KeepsEverythingOfAnIterationInFull) {
  for (const auto& shared : runs().full.iterations) {
    const IterationTrace& iteration = *shared;
    EXPECT_EQ(iteration.render.pixels.size(), static_cast<std::size_t>(iteration.edge_pixel_count));
    EXPECT_EQ(iteration.templates.size(), static_cast<std::size_t>(iteration.template_count));
    EXPECT_EQ(iteration.matches.size(), iteration.templates.size());
    EXPECT_EQ(iteration.correspondences.size(),
              static_cast<std::size_t>(iteration.correspondence_count));
    EXPECT_EQ(iteration.pnp.inlier.size(), iteration.correspondences.size());
    EXPECT_EQ(std::accumulate(iteration.pnp.inlier.begin(), iteration.pnp.inlier.end(), 0),
              iteration.pnp.inlier_count);
    EXPECT_EQ(iteration.refinement.samples.size(),
              static_cast<std::size_t>(iteration.refinement.sample_count));
  }
  const IterationTrace& first = *runs().full.iterations.front();
  const IterationTrace& last = *runs().full.iterations.back();
  EXPECT_EQ(first.kind, IterationKind::kMatch);
  EXPECT_GT(first.template_count, 6);
  EXPECT_EQ(last.kind, IterationKind::kRefine);
  EXPECT_GT(last.refinement.sample_count, 100);
}

TEST(Localize, KeepsTheCountsInSummary) {
  ASSERT_EQ(runs().summary.iterations.size(), runs().full.iterations.size());
  EXPECT_EQ(runs().summary.edges->edge_count, runs().full.edges->edge_count);
  EXPECT_TRUE(runs().summary.edges->level[0].words.empty());
  for (std::size_t i = 0; i < runs().full.iterations.size(); ++i) {
    const IterationTrace& brief = *runs().summary.iterations[i];
    const IterationTrace& whole = *runs().full.iterations[i];
    EXPECT_TRUE(brief.render.pixels.empty());
    EXPECT_TRUE(brief.templates.empty());
    EXPECT_TRUE(brief.refinement.samples.empty());
    EXPECT_EQ(brief.edge_pixel_count, whole.edge_pixel_count);
    EXPECT_EQ(brief.template_count, whole.template_count);
    EXPECT_EQ(brief.searched_count, whole.searched_count);
    EXPECT_EQ(brief.support(), whole.support());
    EXPECT_EQ(brief.rms_px(), whole.rms_px());
    EXPECT_EQ(brief.correction_translation_m, whole.correction_translation_m);
  }
}

TEST(Localize, ChainsThePosesOfItsIterations) {
  const auto& iterations = runs().full.iterations;
  EXPECT_EQ(iterations.front()->camera_from_station_before,
            runs().full.candidates.front().camera_from_station);
  for (std::size_t i = 1; i < iterations.size(); ++i) {
    const IterationTrace& before = *iterations[i - 1];
    EXPECT_TRUE(iterations[i]->camera_from_station_before == before.camera_from_station ||
                iterations[i]->attempt != before.attempt)
        << i;
  }
  EXPECT_EQ(iterations.back()->camera_from_station, runs().full.camera_from_station);
}

TEST(Localize, AccountsForItsTime) {
  StageSeconds sum;
  for (const auto& shared : runs().full.iterations) {
    const IterationTrace& iteration = *shared;
    EXPECT_GT(iteration.seconds.rendering, 0.0);
    sum.rendering += iteration.seconds.rendering;
    sum.matching += iteration.seconds.matching;
  }
  EXPECT_NEAR(sum.rendering, runs().full.seconds.rendering, 1e-9);
  EXPECT_NEAR(sum.matching, runs().full.seconds.matching, 1e-9);
  EXPECT_GT(runs().full.seconds.initialization, 0.0);
}

TEST(Localize, RecordsAFailedIterationUpToItsStage) {
  LocalizerOptions options = defaultProfile();
  options.search.enabled = false;
  options.templates.count = 4;  // fewer than a run needs
  options.loop.max_attempts = 1;
  const LocalizationTrace trace = localize(runs().example.problem(), options, RecordLevel::kFull);
  ASSERT_EQ(trace.status, LocalizationStatus::kTooFewTemplates);
  ASSERT_EQ(trace.iterations.size(), 1u);
  const IterationTrace& failed = *trace.iterations.front();
  EXPECT_EQ(failed.status, LocalizationStatus::kTooFewTemplates);
  EXPECT_EQ(failed.reached, Stage::kTemplates);
  EXPECT_GT(failed.edge_pixel_count, 0);
  EXPECT_GT(failed.template_count, 0);
  EXPECT_TRUE(failed.matches.empty());
  EXPECT_TRUE(failed.pnp.inlier.empty());
  EXPECT_EQ(failed.correction_translation_m, 0.0);
  EXPECT_EQ(trace.camera_from_station.translation_m, trace.camera_from_station_seed.translation_m);
}

TEST(Localize, GivesTheSameWithinALimit) {
  const LocalizationProblem problem = runs().example.problem();
  std::size_t bytes = 0;
  ASSERT_EQ(requiredBytes(sizeOf(problem), defaultProfile(), bytes), Status::kOk);
  RunSettings settings;
  settings.level = RecordLevel::kSummary;
  settings.memory_limit = bytes + inputBytes(problem);
  const LocalizationTrace exact = localize(problem, defaultProfile(), settings);
  EXPECT_EQ(exact.digest, runs().full.digest);
  EXPECT_EQ(exact.memory.total(), settings.memory_limit);
  EXPECT_EQ(exact.arena_bytes, bytes);
  settings.memory_limit = kFlightMemoryBytes;
  EXPECT_EQ(localize(problem, defaultProfile(), settings).digest, runs().full.digest);

  settings.memory_limit = bytes + inputBytes(problem) - 1;
  const LocalizationTrace refused = localize(problem, defaultProfile(), settings);
  EXPECT_EQ(refused.status, LocalizationStatus::kFault);
  EXPECT_EQ(refused.fault, Status::kArenaTooSmall);
  EXPECT_TRUE(refused.iterations.empty());
  EXPECT_EQ(refused.memory.total(), settings.memory_limit + 1);
}

/// That the number of threads changes no bit: SameBits.Threads.
TEST(ThreadsOf, SharesTheCoresOutUnlessMemoryIsLimited) {
  EXPECT_EQ(threadsOf(5, 0), 5);
  EXPECT_EQ(threadsOf(5, kFlightMemoryBytes), 5);
  EXPECT_EQ(threadsOf(0, kFlightMemoryBytes), 1);
  EXPECT_EQ(threadsOf(0, 0, 100000), 1);
  EXPECT_GE(threadsOf(0, 0), 1);
}

TEST(Localize, CountsWhatTheProblemPointsTo) {
  LocalizationProblem problem = runs().example.problem();
  const std::size_t bytes = inputBytes(problem);
  const auto pixels = static_cast<std::size_t>(problem.image.width * problem.image.height);
  EXPECT_EQ(bytes, pixels + problem.mesh.vertices_in_station_m.size() * 12 +
                       problem.mesh.faces.size() * 8 +
                       problem.mesh.parts.size() * sizeof(ScenePart));
  std::vector<std::uint64_t> words(100);
  BitImage ignore;
  ignore.words = words;
  problem.ignore = &ignore;
  EXPECT_EQ(inputBytes(problem), bytes + 800);
}

}  // namespace
}  // namespace boresight::sessions
