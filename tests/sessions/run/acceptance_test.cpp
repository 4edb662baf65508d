// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/acceptance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/text/text_table.h"
#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

CompetingPose competingPose(double margin_nats) {
  CompetingPose pose;
  pose.margin_nats = margin_nats;
  return pose;
}

TEST(AcceptanceText, SearchedRun_StatesTheProbabilityWithItsParts) {
  LocalizationTrace run = test::exampleTrace();
  run.competing_poses = {competingPose(7.5), competingPose(4.0)};
  EXPECT_THAT(
      acceptanceText(run),
      AllOf(HasSubstr("right is " + fixedText(100.0 * run.probability, 1) + " %, needed 50.0 %"),
            HasSubstr("its edges " + fixedText(run.evidence.strongest_nats(), 2) + " nats"),
            HasSubstr("quadrant " + fixedText(run.evidence.weakest_nats(), 2) + " nats"),
            HasSubstr("support " + fixedText(100.0 * run.support.share(), 1) + " %"),
            HasSubstr("candidate 1 of " + std::to_string(run.candidates.size())),
            HasSubstr("2 competing poses are similar; the closest has 4.0 nats less evidence")));
  run.competing_poses = {competingPose(-2.5)};
  EXPECT_THAT(acceptanceText(run), HasSubstr("it has 2.5 nats more evidence"));
}

TEST(AcceptanceText, RunWithoutSearch_StatesItsEdgeSupport) {
  const auto run = test::exampleRunOfSeed();
  EXPECT_FALSE(hasProbability(*run));
  EXPECT_THAT(acceptanceText(*run), AllOf(HasSubstr("Edge support is"), Not(HasSubstr("probab"))));
}

TEST(HasProbability, EvidenceOfAnEarlierAttempt_DoesNotCount) {
  LocalizationTrace run = test::exampleTrace();
  EXPECT_TRUE(hasProbability(run));
  run.status = LocalizationStatus::kBlurred;
  EXPECT_TRUE(hasProbability(run));
  run.status = LocalizationStatus::kPnpFailed;
  EXPECT_FALSE(hasProbability(run));
  EXPECT_EQ(acceptanceText(run), "");
}

TEST(AcceptanceText, PoseFromTheSeed_IsReportedSo) {
  LocalizationTrace run = test::exampleTrace();
  test::editIteration(run, 0, [&](IterationTrace& first) {
    first.camera_from_station_before = run.camera_from_station_seed;
  });
  EXPECT_THAT(acceptanceText(run), HasSubstr("The pose comes from the seed"));
}

}  // namespace
}  // namespace boresight::sessions
