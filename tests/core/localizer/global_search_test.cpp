// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/global_search.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/core/localizer/scripted_pass.h"

namespace boresight {
namespace {

using test::ScriptedPass;
using test::seedInFront;

class GlobalSearchTest : public testing::Test {
 protected:
  GlobalSearchTest() {
    pass.options.wide.rotation_rad = 3.15;
    problem.camera_from_station_seed = seedInFront().camera_from_station;
    search = GlobalSearch(problem, pass.context(), restarts, finalists);
  }

  /// Runs the passes of a round; the pass at `solved_at` has more evidence than the others.
  Ruling runRound(int solved_at) {
    Ruling ruling;
    for (int place = 0; !ruling.iteration_complete; ++place) {
      const PassPlan plan = search.plan(pass.context());
      plans.push_back(plan);
      (void)pass.match(plan, plan.camera_from_station, 5);
      pass.records[static_cast<std::size_t>(plan.record)].camera_from_station =
          plan.camera_from_station;
      pass.outcome.support.rendered = 1000;
      pass.outcome.support.covered = place == solved_at ? 900 : 100;
      pass.outcome.support.displaced = 4000;
      pass.outcome.support.displaced_covered = 200;
      ruling = search.take(pass.outcome, pass.context(), pass.records, digest);
    }
    return ruling;
  }

  ScriptedPass pass;
  LocalizationProblem problem;
  std::array<HypothesisSummary, 128> restarts;
  std::array<HypothesisSummary, 3> finalists;
  GlobalSearch search;
  std::vector<PassPlan> plans;
  DigestWriter digest;
};

TEST_F(GlobalSearchTest, FullTurn_CoversItEvenly) {
  (void)runRound(0);
  EXPECT_EQ(plans.size(), 45u);  // 360 deg in steps of 8 deg at most
  for (const PassPlan& plan : plans) EXPECT_TRUE(plan.measures_support);
}

TEST_F(GlobalSearchTest, BestRestart_IsTheFirstFinalistAndStartsTheAttempt) {
  Ruling ruling = runRound(7);
  EXPECT_EQ(ruling.next, Ruling::Next::kPass);
  const Pose expected = plans[7].camera_from_station;
  plans.clear();
  ruling = runRound(0);
  EXPECT_TRUE(ruling.found());
  EXPECT_EQ(plans.size(), 3u);
  EXPECT_EQ(plans[0].camera_from_station, expected);
  EXPECT_FALSE(search.isSearching());
  const Attempt attempt = search.nextAttempt(0, pass.options);
  EXPECT_EQ(attempt.camera_from_station(), expected);
}

TEST_F(GlobalSearchTest, Finalists_AreUsedOnceEach) {
  (void)runRound(7);
  (void)runRound(0);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(search.hasFinalist());
    (void)search.nextAttempt(i, pass.options);
  }
  EXPECT_FALSE(search.hasFinalist());
}

TEST_F(GlobalSearchTest, NoRestartSolved_Fails) {
  Ruling ruling;
  while (ruling.next == Ruling::Next::kPass) {
    (void)pass.fail(search.plan(pass.context()), Stage::kMatch, LocalizationStatus::kTooFewMatches);
    ruling = search.take(pass.outcome, pass.context(), pass.records, digest);
  }
  EXPECT_EQ(ruling.status, LocalizationStatus::kTooFewMatches);
  EXPECT_FALSE(search.hasFinalist());
}

}  // namespace
}  // namespace boresight
