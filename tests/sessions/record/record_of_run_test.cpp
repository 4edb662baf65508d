// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <gtest/gtest.h>

#include "sessions/record/compare_records.h"
#include "sessions/run/runner.h"
#include "tests/sessions/record/recorded_run.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

void expectEqual(const RecordedIteration& recorded, const RecordedIteration& other) {
  const IterationTrace& a = recorded.trace;
  const IterationTrace& b = other.trace;
  SCOPED_TRACE(a.index);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.camera_from_station_before, b.camera_from_station_before);
  EXPECT_EQ(a.camera_from_station, b.camera_from_station);
  const auto counts = [](const IterationTrace& trace) {
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
  const auto figures = [](const IterationTrace& trace) {
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

TEST(RecordOfRun, EqualsTheRecordOfTheFlightSide) {
  const LocalizationProblem& problem = exampleRun().problem;
  const RecordedRun& run = exampleRun().run;
  const OnboardRecord record = recordOf(run.trace, &problem);
  EXPECT_TRUE(record.whole());
  expectEqual(record, run.record);
  const auto supportOf = [](const OnboardRecord& of) {
    const EdgeSupport& support = of.iterations.back().support.value();
    return std::array{support.rendered,           support.covered, support.displaced,
                      support.displaced_covered,  support.seen,    support.explained,
                      support.displaced_explained};
  };
  EXPECT_EQ(supportOf(record), supportOf(run.record));
}

/// Attempts that failed, hypotheses, options taken up on the way, and stages that were not reached.
TEST(RecordOfRun, OfRunsThatFailToo) {
  const LocalizationProblem& problem = exampleRun().problem;
  std::array<LocalizerOptions, 5> options;
  options.fill(recordedOptions());
  options[0].support.min_support = 1.0;
  options[1].pnp.min_inliers = 80;
  options[2].templates.count = 4;  // too few
  options[3].render.max_edge_pixels = 1000;
  options[4].loop.render_again_px = 5.0;
  for (const RunPlan& plan :
       {RunPlan(options[0]), RunPlan(options[1]), RunPlan(options[2]), RunPlan(options[3]),
        RunPlan(recordedOptions(), {{2, options[4]}, {90, recordedOptions()}})}) {
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
  EXPECT_THAT(alone.missing, ElementsAre(HasSubstr("hashes of the inputs")));
  // One digest is the same inputs, too.
  const RecordComparison equal = compareRecords(alone, run.record);
  EXPECT_EQ(equal.verdict, RunVerdict::kEqual);
  EXPECT_EQ(equal.translation_mm, 0.0);
  const auto summary = localize(problem, RunPlan(recordedOptions()), RecordLevel::kSummary);
  const OnboardRecord thin = recordOf(summary, &problem);
  EXPECT_FALSE(thin.whole());
  EXPECT_FALSE(thin.edges);
  const auto found = compareRecords(thin, run.record);
  EXPECT_FALSE(found.first);
  EXPECT_EQ(found.verdict, RunVerdict::kEqual);
}

/// A trace has the support of the pose that was judged last: the flight record has all of them.
TEST(RecordOfRun, SupportOfEarlierAttempts_IsListedAsMissing) {
  LocalizerOptions strict = recordedOptions();
  strict.search.enabled = false;
  strict.support.min_support = 1.0;
  const RecordedRun run = recordRun(exampleRun().problem, RunPlan(strict));
  ASSERT_GT(run.trace.attempts, 1);
  const OnboardRecord record = recordOf(run.trace, &exampleRun().problem);
  std::vector<std::string> missing;
  bool last = true;
  for (std::size_t i = record.iterations.size(); i-- > 0;) {
    const bool judged = run.record.iterations[i].support.has_value();
    EXPECT_EQ(record.iterations[i].support.has_value(), judged && last) << i;
    if (judged && !last)
      missing.push_back("the edge support of iteration " + std::to_string(i + 1));
    if (judged) last = false;
  }
  EXPECT_FALSE(last) << "a pose was judged";
  ASSERT_THAT(missing, Not(IsEmpty()));
  EXPECT_EQ(record.missing, missing);
}

TEST(RecordOfRun, Summary_NamesWhatItLacks) {
  const auto& problem = exampleRun().problem;
  const auto summary = localize(problem, RunPlan(recordedOptions()), RecordLevel::kSummary);
  const OnboardRecord record = recordOf(summary, &problem);
  std::vector<std::string> missing = {"the edges of the image"};
  for (const RecordedIteration& iteration : exampleRun().run.record.iterations) {
    const std::string of = " of iteration " + std::to_string(iteration.trace.index + 1);
    missing.push_back("the render" + of);
    if (iteration.templates) missing.push_back("the templates" + of);
  }
  EXPECT_EQ(record.missing, missing);
}

TEST(RecordOfRun, OfAHaltedRunHasNoEnd) {
  const LocalizationProblem& problem = exampleRun().problem;
  Runner run(problem, recordedOptions(), {.level = RecordLevel::kStages});
  run.advance(StepUntil::kIteration);
  run.advance(StepUntil::kStage);
  ASSERT_TRUE(run.trace().last_under_way);
  const OnboardRecord record = recordOf(run.trace(), &problem);
  EXPECT_EQ(record.iterations.size(), 1u);
  EXPECT_FALSE(record.end);
  EXPECT_THAT(record.missing, Contains("how the run ended: it was halted"));
}

/// Of a halted run, options that no iteration has had are not in the record.
TEST(RecordOfRun, ChangeOfOptions_IsRecordedOnceAnIterationHasThem) {
  LocalizationTrace trace = exampleRun().run.trace;
  const auto count = static_cast<std::int32_t>(trace.complete());
  trace.changes = {{1, recordedOptions()}, {count - 1, recordedOptions()}};
  EXPECT_EQ(recordOf(trace, nullptr).options.size(), 3u);
  EXPECT_EQ(recordOf(trace, nullptr).options[2].first_iteration, count - 1);
  trace.changes.back().iteration = count;
  EXPECT_EQ(recordOf(trace, nullptr).options.size(), 2u);
}

}  // namespace
}  // namespace boresight::test
