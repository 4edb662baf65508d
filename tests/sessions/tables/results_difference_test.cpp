// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_difference.h"

#include <gtest/gtest.h>

#include "tests/sessions/tables/made_runs.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

ResultsSet setOf(std::vector<RunResult> runs) {
  ResultsSet set;
  set.runs = std::move(runs);
  return set;
}

TEST(CompareResults, JudgesRunByRun) {
  ResultsSet before = setOf(
      {madeRun("bc-1", "whs", true, 0.1, 0.0, 0.0), madeRun("bc-2", "whs", true, 0.1, 0.0, 0.0),
       madeRun("bc-3", "whs", false, 0.0, 0.0, 0.0), madeRun("bc-4", "whs", false, 0.0, 0.0, 0.0),
       madeRun("bc-5", "whs", true, 2.0, 0.0, 0.0), madeRun("bc-6", "whs", true, 0.0, 0.0, 0.0)});
  ResultsSet after = setOf(
      {madeRun("bc-1", "whs", true, 0.1, 0.0, 0.0), madeRun("bc-2", "whs", true, 0.3, 0.0, 0.0),
       madeRun("bc-3", "whs", true, 0.2, 0.0, 0.0), madeRun("bc-4", "whs", true, 5.0, 0.0, 0.0),
       madeRun("bc-5", "whs", true, 1.0, 0.0, 0.0), madeRun("bc-7", "whs", true, 0.0, 0.0, 0.0)});
  for (RunResult& run : after.runs)
    if (run.case_id != "bc-1") run.digest += "'";
  const ResultsDifference made = compareResults(before, after);
  ASSERT_EQ(made.pairs.size(), 5u);
  EXPECT_EQ(made.pairs[0].change, RunChange::kSame) << "bit for bit";
  EXPECT_EQ(made.pairs[1].change, RunChange::kSame) << "both within the requirement";
  EXPECT_EQ(made.pairs[2].change, RunChange::kBetter) << "a right pose where there was none";
  EXPECT_EQ(made.pairs[3].change, RunChange::kWorse) << "a wrong pose is worse than none";
  EXPECT_EQ(made.pairs[4].change, RunChange::kBetter) << "nearer, of two wrong ones";
  EXPECT_EQ(differenceSentence(made),
            "5 runs in both: 2 better, 1 worse, 2 the same (1 bit for bit); 1 only before; 1 only "
            "after.");
  EXPECT_EQ(differenceTable(made, false).rows.size(), 3u);
  EXPECT_EQ(differenceTable(made, true).rows.size(), 5u);
}

TEST(CompareResults, PairsByMethodWhereThereAreSeveral) {
  const ResultsSet whs = setOf({madeRun("bc-1", "whs", true, 0.1, 0.0, 0.0)});
  const ResultsSet ncc = setOf({madeRun("bc-1", "ncc", true, 0.1, 0.0, 0.0)});
  const ResultsSet both = setOf({whs.runs[0], ncc.runs[0]});
  EXPECT_EQ(compareResults(whs, ncc).pairs.size(), 1u) << "one method against another";
  EXPECT_EQ(compareResults(both, ncc).pairs.size(), 1u);
  EXPECT_EQ(compareResults(both, ncc).only_before, 1);
}

TEST(CompareResults, GoesByCompletionWithoutTruth) {
  ResultsSet before = setOf({madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)});
  before.runs[0].error.reset();
  ResultsSet after = before;
  after.runs[0].completed = false;
  after.runs[0].status = "pnp_failed";
  const ResultsDifference made = compareResults(before, after);
  EXPECT_EQ(made.worse, 1);
  EXPECT_EQ(made.pairs[0].why, "converged before, now pnp_failed");
}

}  // namespace
}  // namespace boresight::sessions
