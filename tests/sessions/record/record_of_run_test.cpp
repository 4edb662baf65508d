// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/record/compare_records.h"
#include "sessions/run/runner.h"
#include "tests/sessions/record/recorded_run.h"

namespace boresight::test {
namespace {

using sessions::OnboardRecord;
using sessions::RecordedIteration;
using sessions::recordOf;
using sessions::RunPlan;

void expectEqual(const RecordedIteration& recorded, const RecordedIteration& other) {
  const sessions::IterationTrace& a = recorded.trace;
  const sessions::IterationTrace& b = other.trace;
  SCOPED_TRACE(a.index);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.camera_from_station_before, b.camera_from_station_before);
  EXPECT_EQ(a.camera_from_station, b.camera_from_station);
  const auto counts = [](const sessions::IterationTrace& trace) {
    return std::array{trace.index,
                      trace.attempt,
                      trace.level,
                      trace.edge_pixel_count,
                      trace.template_side_px,
                      trace.template_count,
                      trace.searched_count,
                      trace.correspondence_count,
                      trace.pnp.inlier_count,
                      trace.pnp.samples,
                      trace.refinement.found_count,
                      trace.refinement.used_count,
                      trace.refinement.sample_count,
                      static_cast<std::int32_t>(trace.hypotheses.size()),
                      trace.chosen_hypothesis};
  };
  EXPECT_EQ(counts(a), counts(b));
  const auto figures = [](const sessions::IterationTrace& trace) {
    const bool rolled = !trace.hypotheses.empty();
    return std::array{
        trace.threshold_px,
        trace.rms_px(),
        rolled ? trace.hypotheses[static_cast<std::size_t>(trace.chosen_hypothesis)].roll_rad : 0.0,
        trace.correction_translation_m,
        trace.correction_rotation_rad,
        trace.correction_image_px};
  };
  EXPECT_EQ(figures(a), figures(b));
  EXPECT_EQ(recorded.render_sha256, other.render_sha256);
  EXPECT_TRUE(recorded.templates == other.templates);
}

void expectEqual(const OnboardRecord& a, const OnboardRecord& b) {
  ASSERT_TRUE(a.inputs && b.inputs && a.edges && b.edges);
  EXPECT_EQ(a.inputs->sha256.pixels, b.inputs->sha256.pixels);
  EXPECT_EQ(a.inputs->sha256.ignore, b.inputs->sha256.ignore);
  EXPECT_EQ(a.inputs->sha256.scene, b.inputs->sha256.scene);
  EXPECT_EQ(a.inputs->sha256.camera, b.inputs->sha256.camera);
  EXPECT_EQ(a.inputs->width, b.inputs->width);
  EXPECT_EQ(a.inputs->height, b.inputs->height);
  EXPECT_EQ(a.inputs->camera_from_station_seed, b.inputs->camera_from_station_seed);
  EXPECT_EQ(a.inputs->uncertainty.translation_m, b.inputs->uncertainty.translation_m);
  EXPECT_EQ(a.inputs->uncertainty.rotation_rad, b.inputs->uncertainty.rotation_rad);
  EXPECT_EQ(a.inputs->uncertainty.pivot_in_camera_m, b.inputs->uncertainty.pivot_in_camera_m);
  EXPECT_EQ(a.inputs->end_effector_in_camera_m, b.inputs->end_effector_in_camera_m);
  EXPECT_EQ(a.options, b.options);
  EXPECT_EQ(a.edges->sha256, b.edges->sha256);
  EXPECT_EQ(a.edges->low_threshold, b.edges->low_threshold);
  EXPECT_EQ(a.edges->high_threshold, b.edges->high_threshold);
  EXPECT_EQ(a.edges->edge_count, b.edges->edge_count);
  ASSERT_EQ(a.iterations.size(), b.iterations.size());
  for (std::size_t i = 0; i < a.iterations.size(); ++i)
    expectEqual(a.iterations[i], b.iterations[i]);
  ASSERT_TRUE(a.end && b.end);
  EXPECT_EQ(a.end->status, b.end->status);
  EXPECT_EQ(a.end->fault, b.end->fault);
  EXPECT_EQ(a.end->iterations, b.end->iterations);
  EXPECT_EQ(a.end->attempts, b.end->attempts);
  EXPECT_EQ(a.end->camera_from_station, b.end->camera_from_station);
  EXPECT_EQ(a.end->covariance, b.end->covariance);
  EXPECT_EQ(a.end->digest, b.end->digest);
}

std::array<std::int32_t, 7> countsOf(const EdgeSupport& support) {
  return {support.rendered,           support.covered, support.displaced,
          support.displaced_covered,  support.seen,    support.explained,
          support.displaced_explained};
}

TEST(RecordOfRun, EqualsTheRecordOfTheFlightSide) {
  const LocalizationProblem& problem = exampleRun().problem;
  const RecordedRun& run = exampleRun().run;
  const OnboardRecord record = recordOf(run.trace, &problem);
  EXPECT_TRUE(record.whole());
  expectEqual(record, run.record);
  ASSERT_TRUE(record.iterations.back().support && run.record.iterations.back().support);
  EXPECT_EQ(countsOf(*record.iterations.back().support),
            countsOf(*run.record.iterations.back().support));

  sessions::Runner stepped(problem, recordedOptions());
  stepped.advance(sessions::StepUntil::kEnd);
  expectEqual(recordOf(stepped.trace(), &problem), run.record);
}

/// Attempts that failed, hypotheses, options taken up on the way, and stages that were not reached.
TEST(RecordOfRun, OfRunsThatFailToo) {
  const LocalizationProblem& problem = exampleRun().problem;
  std::vector<RunPlan> plans;
  const auto with = [](auto change) {
    LocalizerOptions options = recordedOptions();
    change(options);
    return options;
  };
  plans.emplace_back(with([](auto& options) { options.support.min_support = 1.0; }));
  plans.emplace_back(with([](auto& options) { options.pnp.min_inliers = 80; }));
  plans.emplace_back(with([](auto& options) { options.templates.count = 4; }));  // too few
  plans.emplace_back(with([](auto& options) { options.render.max_edge_pixels = 1000; }));
  plans.push_back(RunPlan(recordedOptions(),
                          {{2, with([](auto& options) { options.loop.render_again_px = 5.0; })},
                           {90, recordedOptions()}}));
  for (const RunPlan& plan : plans) {
    const RecordedRun run = recordRun(problem, plan);
    SCOPED_TRACE(localizationStatusText(run.trace.status));
    expectEqual(recordOf(run.trace, &problem), run.record);
  }
}

TEST(RecordOfRun, SaysWhatATraceAloneLacks) {
  const LocalizationProblem& problem = exampleRun().problem;
  const RecordedRun& run = exampleRun().run;
  const OnboardRecord alone = recordOf(run.trace, nullptr);
  EXPECT_FALSE(alone.inputs);
  EXPECT_THAT(alone.missing, testing::ElementsAre(testing::HasSubstr("hashes of the inputs")));
  // One digest is the same inputs, too.
  EXPECT_EQ(compareRecords(alone, run.record).verdict, sessions::RunVerdict::kEqual);
  const auto summary =
      sessions::localize(problem, RunPlan(recordedOptions()), sessions::RecordLevel::kSummary);
  const OnboardRecord thin = recordOf(summary, &problem);
  EXPECT_FALSE(thin.whole());
  EXPECT_FALSE(thin.edges);
  const auto found = compareRecords(thin, run.record);
  EXPECT_FALSE(found.first);
  EXPECT_EQ(found.verdict, sessions::RunVerdict::kEqual);
}

TEST(RecordOfRun, OfAHaltedRunHasNoEnd) {
  const LocalizationProblem& problem = exampleRun().problem;
  sessions::Runner run(problem, recordedOptions(), {.level = sessions::RecordLevel::kStages});
  run.advance(sessions::StepUntil::kIteration);
  run.advance(sessions::StepUntil::kStage);
  ASSERT_TRUE(run.trace().last_under_way);
  const OnboardRecord record = recordOf(run.trace(), &problem);
  EXPECT_EQ(record.iterations.size(), 1u);
  EXPECT_FALSE(record.end);
  EXPECT_FALSE(record.whole());
}

}  // namespace
}  // namespace boresight::test
