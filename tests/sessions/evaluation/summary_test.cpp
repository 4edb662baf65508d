// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace boresight::sessions {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RunResult run(const std::string& station, bool completed, double normal_mm,
              std::vector<std::string> tags = {}) {
  RunResult result;
  result.case_id = station + "-7";
  result.station = station;
  result.tags = std::move(tags);
  result.status = completed ? "converged" : "pnp_failed";
  result.completed = completed;
  result.error = PoseError{};
  result.error->normal_mm = normal_mm;
  result.error->lateral_mm = 0.1;
  result.requirement = Requirement{};
  result.requirement->normal_mm = 0.4;
  result.seconds.matching = 2.0;
  judge(false, result);
  return result;
}

TEST(Summarize, GroupsByStationAndRange) {
  const std::vector<RunResult> results = {run("os", true, 0.0), run("bc", true, 0.1),
                                          run("bc", true, 0.2, {"far"}), run("bc", true, 0.3)};
  const auto groups = summarize(results);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].station, "bc");
  EXPECT_FALSE(groups[0].far);
  EXPECT_EQ(groups[0].runs, 2);
  EXPECT_TRUE(groups[1].far);
  EXPECT_EQ(groups[2].station, "os");
}

TEST(Summarize, TakesErrorsOfCompletedRunsOnly) {
  const std::vector<RunResult> results = {run("bc", true, -0.3), run("bc", true, 0.1),
                                          run("bc", false, 30.0)};
  const GroupSummary group = summarize(results).front();
  EXPECT_EQ(group.runs, 3);
  EXPECT_EQ(group.completed, 2);
  EXPECT_EQ(group.successful, 2);
  EXPECT_EQ(group.normal_mm.count, 2);
  EXPECT_NEAR(group.normal_mm.mean, -0.1, 1e-12);
  EXPECT_NEAR(group.normal_mm.deviation, 0.2, 1e-12);
  EXPECT_NEAR(group.normal_mm.maximum, 0.3, 1e-12);
  EXPECT_NEAR(group.mean_seconds, 2.0, 1e-12);
}

TEST(Summarize, CountsFalsePositivesAndGrossOnes) {
  const std::vector<RunResult> results = {run("bc", true, 0.1), run("bc", true, 0.5),
                                          run("bc", true, -1.5)};
  const GroupSummary group = summarize(results).front();
  EXPECT_EQ(group.successful, 1);
  EXPECT_EQ(group.false_positives, 2);
  EXPECT_EQ(group.gross_false_positives, 1);
}

TEST(Summarize, KeepsBadInputApart) {
  RunResult bad;
  bad.station = "bc";
  bad.status = "input_error";
  const std::vector<RunResult> results = {bad, run("bc", true, 0.1)};
  const auto groups = summarize(results);
  EXPECT_EQ(groups.front().runs, 1);
  EXPECT_EQ(groups.front().input_errors, 1);
  EXPECT_THAT(summaryTable(results), HasSubstr("1 runs could not start"));
}

TEST(SummaryTable, ShowsTheFiguresOfAGroup) {
  const std::vector<RunResult> results = {run("bc", true, -0.3), run("bc", true, 0.1),
                                          run("bc", false, 30.0)};
  EXPECT_THAT(summaryTable(results), AllOf(HasSubstr("bc"), HasSubstr("near"), HasSubstr("66.7"),
                                           HasSubstr("-0.100 / 0.200 / 0.300")));
}

TEST(SummaryTable, AddsUpSeveralGroups) {
  const std::vector<RunResult> results = {run("bc", true, 0.1), run("os", true, 0.3),
                                          run("os", false, 9.0)};
  const std::string table = summaryTable(results);
  EXPECT_THAT(table.substr(table.find("\nall")),
              AllOf(HasSubstr("3 "), HasSubstr("66.7"), HasSubstr("0.200 / 0.100 / 0.300")));
  EXPECT_THAT(table, HasSubstr("at the end effector"));
  EXPECT_THAT(summaryTable(std::vector<RunResult>{results.front()}), Not(HasSubstr("\nall")));
}

TEST(SummaryTable, LeavesSuccessOpenWithoutTruth) {
  RunResult blind = run("bc", true, 0.0);
  blind.error.reset();
  blind.success.reset();
  const std::vector<RunResult> results = {blind};
  const std::string table = summaryTable(results);
  EXPECT_THAT(table, HasSubstr("100.0"));
  EXPECT_THAT(table, Not(HasSubstr("0.000")));
  EXPECT_EQ(toleranceTable(results), "");
}

TEST(ToleranceTable, GrowsWithTheTolerance) {
  const std::vector<RunResult> results = {run("bc", true, 0.03), run("bc", true, 0.3),
                                          run("bc", true, 0.7), run("bc", false, 0.0)};
  // 0.4 mm times 0.1, 0.25, 0.5, 1, 2, 3
  EXPECT_THAT(toleranceTable(results),
              HasSubstr("bc        near    25.0    25.0    25.0    50.0    75.0    75.0"));
}

TEST(FailureList, NamesRunsThatWereNotSuccessful) {
  std::vector<RunResult> results = {run("bc", true, 0.1), run("os", false, 0.0)};
  results[1].reseed = 4;
  results[1].message = "no pose agrees";
  const std::string list = failureList(results, 10);
  EXPECT_THAT(
      list, AllOf(HasSubstr("os-7 reseed 4: pnp_failed: no pose agrees"), Not(HasSubstr("bc-7"))));
  EXPECT_THAT(failureList(results, 0), HasSubstr("1 more"));
}

TEST(DurationText, ReadsAsAWait) {
  EXPECT_EQ(durationText(0.4), "0 s");
  EXPECT_EQ(durationText(59.0), "59 s");
  EXPECT_EQ(durationText(59.7), "1 min");
  EXPECT_EQ(durationText(150.0), "3 min");
  EXPECT_EQ(durationText(3600.0), "1 h 00 min");
  EXPECT_EQ(durationText(2 * 3600.0 + 5 * 60.0 + 10.0), "2 h 05 min");
  EXPECT_EQ(durationText(24 * 3600.0), "1 day 0 h");
  EXPECT_EQ(durationText(76 * 3600.0), "3 days 4 h");
  EXPECT_EQ(durationText(-1.0), "?");
}

TEST(BatchProgressText, TellsRateAndTimeLeft) {
  EXPECT_EQ(batchProgressText(0, 40, 0, 3.0), "0 of 40 runs, 0 completed");
  EXPECT_EQ(batchProgressText(12, 40, 11, 60.0),
            "12 of 40 runs, 11 completed, 720 an hour, 2 min left");
  EXPECT_EQ(batchProgressText(40, 40, 38, 200.0), "40 of 40 runs, 38 completed, 720 an hour");
}

}  // namespace
}  // namespace boresight::sessions
