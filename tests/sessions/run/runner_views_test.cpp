// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stop_token>

#include "core/base/digest.h"
#include "core/localizer/schedule.h"
#include "core/views/views_localizer.h"
#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

const std::vector<std::string> kNames = {"left", "right"};

/// The example's image by two cameras in one place; the second may have another image.
class RunnerViewsTest : public testing::Test {
 protected:
  RunnerViewsTest() {
    const LocalizationProblem localization_problem = example_.problem();
    for (View& view : views_) {
      view.image = localization_problem.image;
      view.camera = localization_problem.camera;
      view.mesh = localization_problem.mesh;
    }
    problem_.views = views_;
    problem_.rig_from_station_seed = localization_problem.camera_from_station_seed;
    problem_.uncertainty = localization_problem.uncertainty;
  }

  /// What the core makes of it without anybody looking.
  std::unique_ptr<ViewsLocalizer> unwatched() {
    std::size_t bytes = 0;
    EXPECT_EQ(ViewsLocalizer::requiredBytes(problem_, options_, 1, bestKernels(), bytes),
              Status::kOk);
    memory_ = std::make_unique<std::byte[]>(bytes);
    auto result = std::make_unique<ViewsLocalizer>(
        problem_, options_, std::span<std::byte>(memory_.get(), bytes), 1, bestKernels());
    while (!result->step().finished) {
    }
    return result;
  }

  std::vector<LocalizationTrace> watched() {
    Runner run(problem_, options_, kNames);
    run.advance(StepUntil::kEnd);
    return run.traces();
  }

  const test::ExampleCase& example_ = test::osExample();
  std::array<View, 2> views_;
  ViewsProblem problem_;
  LocalizerOptions options_ = defaultProfile();
  std::unique_ptr<std::byte[]> memory_;
};

std::string digestOfView(const ViewsLocalizer& all, std::uint32_t view) {
  DigestWriter writer;
  writer.tag("view of several");
  writer.bytes(all.digest());
  writer.u32(view);
  return hexText(writer.digest()).data();
}

TEST_F(RunnerViewsTest, WatchingChangesNoBit) {
  const auto expected = unwatched();
  ASSERT_EQ(expected->result().status, LocalizationStatus::kConverged);
  const std::vector<LocalizationTrace> views = watched();
  ASSERT_EQ(views.size(), 2u);
  for (std::uint32_t v = 0; v < 2; ++v) {
    const ViewReport& report = expected->result().views[v];
    EXPECT_EQ(views[v].camera_from_station, report.camera_from_station);
    EXPECT_EQ(views[v].status, report.status);
    EXPECT_EQ(views[v].support.rendered, report.support.rendered);
    EXPECT_EQ(views[v].digest, digestOfView(*expected, v));
    EXPECT_EQ(views[v].own_view, v);
    EXPECT_EQ(views[v].views,
              (std::vector<ViewOutcome>{{"left", "converged"}, {"right", "converged"}}));
    EXPECT_EQ(static_cast<int>(views[v].iterations.size()), expected->result().iterations);
  }
  EXPECT_NE(views[0].digest, views[1].digest);
  EXPECT_NE(views[0].digest, test::exampleTrace().digest);
  EXPECT_LT(views[0].covariance(3, 3), test::exampleTrace().covariance(3, 3));
  EXPECT_NEAR(views[1].covariance(3, 3) / views[0].covariance(3, 3), 1.0, 1e-9);
}

/// What one camera sees the other sees, too: whatever is recorded of one is there of the other.
TEST_F(RunnerViewsTest, RecordsOfTheSameImageAreTheSame) {
  options_.loop.max_rolled_hypotheses = 5;
  problem_.uncertainty.rotation_rad.z() = 2.0 * kRollSpacing_rad;
  options_.loop.enough_inliers = 2.0;
  const std::vector<LocalizationTrace> views = watched();
  ASSERT_EQ(views[0].iterations.size(), views[1].iterations.size());
  ASSERT_TRUE(views[0].edges && views[1].edges);
  for (std::size_t level = 0; level < views[0].edges->level.size(); ++level)
    EXPECT_EQ(views[0].edges->level[level].words, views[1].edges->level[level].words);
  for (std::size_t i = 0; i < views[0].iterations.size(); ++i) {
    const IterationTrace& left = *views[0].iterations[i];
    const IterationTrace& right = *views[1].iterations[i];
    EXPECT_EQ(left.index, right.index);
    EXPECT_EQ(left.kind, right.kind);
    EXPECT_EQ(left.render.edges.words, right.render.edges.words) << i;
    EXPECT_EQ(left.templates.size(), right.templates.size());
    EXPECT_EQ(left.pnp.inlier, right.pnp.inlier);
    EXPECT_EQ(left.correspondence_count, right.correspondence_count);
    EXPECT_EQ(left.refinement.used_count, right.refinement.used_count);
    EXPECT_LT(perturbationBetween(left.camera_from_station, right.camera_from_station).norm(),
              1e-12);
  }
  EXPECT_GT(views[0].iterations.front()->hypotheses.size(), 1u)
      << "several were tried, so that one had to be kept";
}

TEST_F(RunnerViewsTest, ABlackViewIsLeftOutAndTheOtherKeepsItsBits) {
  options_.search.enabled = false;
  GrayImage black = example_.image;
  std::fill(black.pixels.begin(), black.pixels.end(), std::uint8_t{0});
  views_[1].image = black.view();
  const std::vector<LocalizationTrace> views = watched();
  EXPECT_EQ(views[0].camera_from_station, test::exampleRunOfSeed()->camera_from_station);
  EXPECT_EQ(views[0].status, LocalizationStatus::kConverged);
  EXPECT_EQ(views[1].status, LocalizationStatus::kTooFewMatches);
  EXPECT_EQ(views[1].camera_from_station, views[1].camera_from_station_seed);
  EXPECT_TRUE(views[1].covariance.isZero(0.0));
  EXPECT_EQ(views[0].views[1].status, "too_few_matches");
  ASSERT_EQ(views[1].iterations.size(), views[0].iterations.size());
  const IterationTrace& matched = *views[1].iterations.front();
  EXPECT_GT(matched.template_count, 0) << "what it tried is there";
  EXPECT_EQ(matched.status, LocalizationStatus::kTooFewMatches);
  const IterationTrace& last = *views[1].iterations.back();
  EXPECT_EQ(last.kind, IterationKind::kRefine);
  EXPECT_TRUE(last.render.edges.words.empty()) << "it was not asked";
  const Pose& pose = views[0].iterations.back()->camera_from_station;
  EXPECT_LT(perturbationBetween(pose, last.camera_from_station).norm(), 1e-12);
}

TEST_F(RunnerViewsTest, HaltsBetweenIterationsAndSlicesAndGoesOn) {
  options_.search.enabled = false;
  const std::string expected = watched().front().digest;
  Runner run(problem_, options_, kNames);
  std::stop_source stopped;
  stopped.request_stop();
  run.advance(StepUntil::kEnd, stopped.get_token());
  EXPECT_FALSE(run.finished());
  EXPECT_EQ(run.trace().complete(), 0u);
  EXPECT_EQ(run.traces()[1].status, LocalizationStatus::kRunning);
  for (std::size_t i = 1; !run.finished() && i < 100; ++i) {
    run.advance(StepUntil::kIteration);
    if (run.finished()) break;
    EXPECT_EQ(run.trace().complete(), i);
    EXPECT_EQ(run.traces()[1].iterations.size(), i);
    EXPECT_TRUE(run.traces()[0].digest.empty());
  }
  EXPECT_EQ(run.traces()[0].digest, expected);
}

TEST_F(RunnerViewsTest, ThreadsChangeNoBit) {
  const std::string expected = watched().front().digest;
  for (const int threads : {1, 3}) {
    Runner run(problem_, options_, kNames, {.threads = threads});
    run.advance(StepUntil::kEnd);
    EXPECT_EQ(run.trace().digest, expected) << threads;
  }
}

TEST_F(RunnerViewsTest, WhatCannotRunSaysSo) {
  options_.templates.count = -1;
  for (const LocalizationTrace& trace : watched()) {
    EXPECT_TRUE(trace.finished);
    EXPECT_EQ(trace.status, LocalizationStatus::kFault);
    EXPECT_EQ(trace.fault, Status::kInvalidOption);
  }
}

}  // namespace
}  // namespace boresight::sessions
