// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/acceptance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/text/text_table.h"
#include "tests/sessions/trace/expect_contained.h"
#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

using test::expectContained;
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
  expectContained(
      acceptanceText(run),
      {"right is " + fixedText(100.0 * run.probability, 1) + " %, needed 50.0 %",
       "edges show 100 % of the evidence",
       "differ along " + fixedText(100.0 * run.evidence.region.separatedShare(), 0) + " % of the",
       "support is " + fixedText(100.0 * run.support.share(), 1) + " %",
       "comes from " + originText(run.hypotheses[static_cast<std::size_t>(run.best_hypothesis)]),
       "2 competing poses are similar; the closest is 55 times less likely"});
  run.competing_poses = {competingPose(-2.5)};
  EXPECT_THAT(acceptanceText(run), HasSubstr("it is 12 times more likely"));
}

TEST(AcceptanceText, RunWithoutSearch_StatesItsEdgeSupport) {
  const auto run = test::exampleRunOfSeed();
  EXPECT_FALSE(hasProbability(*run));
  EXPECT_THAT(acceptanceText(*run), HasSubstr("Edge support is"));
  EXPECT_THAT(acceptanceText(*run), Not(HasSubstr("probab")));
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

TEST(AcceptanceText, ComparedPoses_AreCountedWithTheGapToTheNextBest) {
  LocalizationTrace run = test::exampleTrace();
  PoseHypothesis best;
  best.origin = HypothesisOrigin::kRestart;
  best.number = 2;
  run.hypotheses = {PoseHypothesis(), best};
  run.best_hypothesis = 1;
  run.competitor = -1;
  expectContained(acceptanceText(run),
                  {"most evidence of 2 compared poses", "restart 3 of the best pose"});
  EXPECT_THAT(acceptanceText(run), Not(HasSubstr("next best")));
  run.competitor = 0;
  run.gap = 0.875;
  EXPECT_THAT(acceptanceText(run), HasSubstr("lower by a score of 0.88"));
  run.hypotheses = {best};
  run.hypotheses[0].origin = HypothesisOrigin::kSeed;
  run.best_hypothesis = 0;
  run.competitor = -1;
  EXPECT_THAT(acceptanceText(run), HasSubstr("the only pose found and comes from templates around "
                                             "the seed"));
}

}  // namespace
}  // namespace boresight::sessions
