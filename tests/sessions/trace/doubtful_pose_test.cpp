// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/doubtful_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sessions/trace/run_text.h"
#include "tests/support/example_run.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

/// The example's run as if it had been judged so.
LocalizationTrace judged(double probability,
                         LocalizationStatus status = LocalizationStatus::kNotSupported) {
  LocalizationTrace trace = *test::exampleRun();
  trace.status = status;
  trace.probability = probability;
  trace.camera_from_station = trace.camera_from_station_seed;
  return trace;
}

TEST(DoubtfulPose, IsTheLastPoseOfARunRejectedForAProbabilityWithinTheBounds) {
  const LocalizationTrace trace = judged(0.095);
  const auto pose = doubtfulPose(trace);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->probability, 0.095);
  EXPECT_EQ(pose->camera_from_station, trace.iterations.back()->camera_from_station);
  EXPECT_FALSE(pose->camera_from_station == trace.camera_from_station) << "the run keeps its seed";
}

TEST(DoubtfulPose, BoundsAreFivePercentAndTheProbabilityThatTheRunNeeded) {
  EXPECT_FALSE(doubtfulPose(judged(std::nextafter(0.05, 0.0))));
  EXPECT_TRUE(doubtfulPose(judged(0.05)));
  EXPECT_TRUE(doubtfulPose(judged(std::nextafter(0.3, 0.0))));
  EXPECT_FALSE(doubtfulPose(judged(0.3)));
  LocalizationTrace strict = judged(0.5);
  strict.options.support.min_probability = 0.9;
  EXPECT_TRUE(doubtfulPose(strict));
}

TEST(DoubtfulPose, OtherStatuses_HaveNone) {
  for (int i = 0; i <= static_cast<int>(kLastLocalizationStatus); ++i)
    if (const auto status = static_cast<LocalizationStatus>(i);
        status != LocalizationStatus::kNotSupported) {
      EXPECT_FALSE(doubtfulPose(judged(0.1, status))) << localizationStatusText(status);
      EXPECT_EQ(doubtfulPoseText(judged(0.1, status)), "");
    }
}

TEST(DoubtfulPose, RunsWithoutEvidenceOrPose_AndSeveralViews_HaveNone) {
  LocalizationTrace without_search = judged(0.1);
  without_search.evidence = {};
  EXPECT_FALSE(doubtfulPose(without_search));
  LocalizationTrace without_iterations = judged(0.1);
  without_iterations.iterations.clear();
  EXPECT_FALSE(doubtfulPose(without_iterations));
  LocalizationTrace view = judged(0.1);
  view.views = {{"a", "not_supported"}, {"b", "not_supported"}};
  EXPECT_FALSE(doubtfulPose(view));
}

TEST(DoubtfulPose, ExplanationAndHeadline_StateItsProbabilityAndWhatToDo) {
  const LocalizationTrace trace = judged(0.095);
  const std::string sentence =
      "Doubtful pose, probability 9.5 % (30.0 % needed): compare it with the image, and annotate "
      "from it if it is right.";
  EXPECT_EQ(doubtfulPoseText(trace), sentence);
  EXPECT_THAT(explanation(trace), HasSubstr(". " + sentence));
  EXPECT_EQ(runHeadline(trace).head, "Rejected");
  EXPECT_EQ(runHeadline(trace).sentence, sentence);
  EXPECT_THAT(explanation(judged(0.01)), Not(HasSubstr("oubtful")));
}

/// A plate hides part of the station: the run finds the pose, and lacks the evidence.
TEST(DoubtfulPose, OfAHalfHiddenStation_IsItsBestHypothesisAndNearTheTruth) {
  test::ExampleCase example("os");
  example.image = test::halfHiddenImage();
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = 0.018;
  Runner run(example.problem(), options);
  run.advance(StepUntil::kEnd);
  const LocalizationTrace& trace = run.trace();
  const auto pose = doubtfulPose(trace);
  ASSERT_TRUE(pose) << localizationStatusText(trace.status) << " " << trace.probability;
  ASSERT_GE(trace.best_hypothesis, 0);
  const Pose& best =
      trace.hypotheses[static_cast<std::size_t>(trace.best_hypothesis)].camera_from_station;
  const Pose& truth = example.truth.camera_from_station;
  const auto apart_m = [](const Pose& a, const Pose& b) {
    return (a.translation_m - b.translation_m).norm();
  };
  EXPECT_LT(apart_m(pose->camera_from_station, best), 1e-4);
  EXPECT_LT(apart_m(pose->camera_from_station, truth), 5e-3);
  EXPECT_EQ(trace.camera_from_station, trace.camera_from_station_seed) << "nothing is accepted";
}

}  // namespace
}  // namespace boresight::sessions
