// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/record_of_run.h"

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

void expectEqual(const sessions::RecordedTemplate& a, const sessions::RecordedTemplate& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.searched, b.searched);
  EXPECT_EQ(a.at_border, b.at_border);
  EXPECT_EQ(a.inlier, b.inlier);
  EXPECT_EQ(a.found_x, b.found_x);
  EXPECT_EQ(a.found_y, b.found_y);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.second_score, b.second_score);
}

void expectEqual(const RecordedIteration& a, const RecordedIteration& b) {
  SCOPED_TRACE(a.index);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.attempt, b.attempt);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.level, b.level);
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.threshold_px, b.threshold_px);
  EXPECT_EQ(a.camera_from_station_before, b.camera_from_station_before);
  EXPECT_EQ(a.camera_from_station, b.camera_from_station);
  const auto counts = [](const RecordedIteration& one) {
    return std::array{one.edge_pixels,     one.template_side_px,
                      one.templates_count, one.searched,
                      one.correspondences, one.inliers,
                      one.samples,         one.refinement_found,
                      one.refinement_used, one.refinement_samples,
                      one.hypotheses,      one.chosen_hypothesis};
  };
  EXPECT_EQ(counts(a), counts(b));
  EXPECT_EQ(a.rms_px, b.rms_px);
  EXPECT_EQ(a.roll_rad, b.roll_rad);
  EXPECT_EQ(a.correction_translation_m, b.correction_translation_m);
  EXPECT_EQ(a.correction_rotation_rad, b.correction_rotation_rad);
  EXPECT_EQ(a.correction_image_px, b.correction_image_px);
  EXPECT_EQ(a.render_sha256, b.render_sha256);
  ASSERT_EQ(a.templates.has_value(), b.templates.has_value());
  if (!a.templates) return;
  ASSERT_EQ(a.templates->size(), b.templates->size());
  for (std::size_t i = 0; i < a.templates->size(); ++i)
    expectEqual((*a.templates)[i], (*b.templates)[i]);
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

TEST(RecordOfRun, IsWhatTheFlightSideWrote) {
  const ExampleCase example("os");
  const LocalizationProblem problem = example.problem();
  const RecordedRun run = recordRun(problem, recordedOptions());
  const OnboardRecord made = recordOf(run.trace, &problem);
  EXPECT_TRUE(made.whole());
  expectEqual(made, run.record);
  ASSERT_TRUE(made.iterations.back().support && run.record.iterations.back().support);
  EXPECT_EQ(countsOf(*made.iterations.back().support),
            countsOf(*run.record.iterations.back().support));

  sessions::Runner stepped(problem, recordedOptions());
  stepped.advance(sessions::StepUntil::kEnd);
  expectEqual(recordOf(stepped.trace(), &problem), run.record);
}

/// Attempts that failed, hypotheses, options taken up on the way, and stages that were not reached.
TEST(RecordOfRun, OfRunsThatFailToo) {
  const ExampleCase example("os");
  const LocalizationProblem problem = example.problem();
  std::vector<RunPlan> plans;
  LocalizerOptions options = recordedOptions();
  options.support.min_support = 1.0;
  plans.emplace_back(options);
  options = recordedOptions();
  options.pnp.min_inliers = 80;
  plans.emplace_back(options);
  options = recordedOptions();
  options.templates.count = 4;  // fewer than a run needs
  plans.emplace_back(options);
  options = recordedOptions();
  options.render.max_edge_pixels = 1000;
  plans.emplace_back(options);
  options = recordedOptions();
  options.loop.render_again_px = 5.0;
  plans.push_back(RunPlan(recordedOptions(), {{2, options}, {90, recordedOptions()}}));
  for (const RunPlan& plan : plans) {
    const RecordedRun run = recordRun(problem, plan);
    SCOPED_TRACE(localizationStatusText(run.trace.status));
    expectEqual(recordOf(run.trace, &problem), run.record);
  }
}

TEST(RecordOfRun, SaysWhatATraceAloneLacks) {
  const ExampleCase example("os");
  const LocalizationProblem problem = example.problem();
  const RecordedRun run = recordRun(problem, recordedOptions());
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
  const ExampleCase example("os");
  const LocalizationProblem problem = example.problem();
  sessions::Runner run(problem, recordedOptions(), {.level = sessions::RecordLevel::kStages});
  run.advance(sessions::StepUntil::kIteration);
  run.advance(sessions::StepUntil::kStage);
  ASSERT_TRUE(run.trace().last_under_way);
  const OnboardRecord made = recordOf(run.trace(), &problem);
  EXPECT_EQ(made.iterations.size(), 1u);
  EXPECT_FALSE(made.end);
  EXPECT_FALSE(made.whole());
}

}  // namespace
}  // namespace boresight::test
