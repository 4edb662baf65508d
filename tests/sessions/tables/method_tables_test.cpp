// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <cmath>

#include "sessions/tables/flight_table.h"
#include "sessions/tables/strata_table.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

/// By hand: NCC completes 3 of 4, of which one is beyond the lateral, one beyond the rotation.
std::vector<RunResult> runsOfTwoMethods() {
  return {madeRun("bc-1", "ncc", true, 0.1, 0.2, 1.0), madeRun("bc-2", "ncc", true, -0.3, 0.8, 3.0),
          madeRun("bc-3", "ncc", true, 0.2, 0.2, 5.0),
          madeRun("bc-4", "ncc", false, 9.0, 9.0, 90.0),
          madeRun("bc-1", "whs", true, 0.0, 0.1, 0.5)};
}

TEST(MethodFigures, AreThoseOfTheRuns) {
  const auto rows = methodFigures(runsOfTwoMethods());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].method, "seed");
  EXPECT_EQ(rows[0].runs, 4) << "each seed once, though two methods began from the first";
  EXPECT_DOUBLE_EQ(*rows[0].completed.percent(), 100.0);
  EXPECT_DOUBLE_EQ(*rows[0].success.percent(), 0.0);
  EXPECT_DOUBLE_EQ(rows[0].error[1].mean, 4.0);
  EXPECT_EQ(rows[0].false_positives.count, 0);

  const MethodFigures& ncc = rows[1];
  EXPECT_EQ(ncc.method, "ncc");
  EXPECT_EQ(ncc.runs, 4);
  EXPECT_EQ(ncc.images, 4);
  EXPECT_DOUBLE_EQ(*ncc.completed.percent(), 75.0);
  EXPECT_DOUBLE_EQ(*ncc.success.percent(), 25.0);
  EXPECT_EQ(ncc.false_positives.count, 2);
  EXPECT_DOUBLE_EQ(*ncc.false_positives.percent(), 50.0);
  EXPECT_EQ(ncc.gross_false_positives, 0);
  const Statistics& normal_mm = ncc.error[0];
  EXPECT_EQ(normal_mm.count, 3);
  EXPECT_NEAR(normal_mm.mean, 0.0, 1e-12);
  EXPECT_NEAR(normal_mm.deviation, std::sqrt((0.01 + 0.09 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(normal_mm.maximum, 0.3, 1e-12);
  EXPECT_NEAR(ncc.error[1].mean, 0.4, 1e-12);
  EXPECT_NEAR(ncc.error[2].maximum, 5.0, 1e-12);
  EXPECT_EQ(ncc.error[3].count, 0) << "no run has a projection error";
  EXPECT_DOUBLE_EQ(*ncc.within_percent[0], 75.0);
  EXPECT_DOUBLE_EQ(*ncc.within_percent[1], 50.0);
  EXPECT_DOUBLE_EQ(*ncc.within_percent[2], 50.0);
  EXPECT_EQ(ncc.within_percent[3], std::nullopt) << "no requirement names it";
  EXPECT_EQ(rows[2].method, "whs");
}

TEST(MethodFigures, KeepStationsAndRangesApartAndLeaveOutRefusedInputs) {
  std::vector<RunResult> runs = {madeRun("os-1", "whs"), madeRun("bc-1", "whs"),
                                 madeRun("bc-2", "whs"), madeRun("bc-3", "whs", false)};
  runs[2].tags = {"far"};
  runs[3].status = "input_error";
  std::string order;
  for (const MethodFigures& row : methodFigures(runs))
    order += row.station + (row.far ? "-far " : " ") + row.method + std::to_string(row.runs) + ", ";
  EXPECT_EQ(order, "bc seed1, bc whs1, bc-far seed1, bc-far whs1, os seed1, os whs1, ");
}

TEST(MethodFigures, StateBoundsOfClopperAndPearson) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 59; ++i) runs.push_back(madeRun("bc-" + std::to_string(i % 7), "whs"));
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_EQ(figures.images, 7);
  // 59 runs without a failure demonstrate 95 %: 0.05^(1 / 59) = 0.9505.
  EXPECT_NEAR(*figures.completed.leastPercent(), 95.05, 0.01);
  EXPECT_NEAR(*figures.success.leastPercent(), 95.05, 0.01);
  EXPECT_NEAR(*figures.false_positives.mostPercent(), 4.95, 0.01);
  EXPECT_DOUBLE_EQ(*figures.completed.mostPercent(), 100.0);
}

TEST(MethodFigures, CountRunsAtTheLimitOfIterationsBothWays) {
  std::vector<RunResult> runs(4, madeRun("bc-1", "whs", true, 0.1));
  for (std::size_t i = 1; i < runs.size(); ++i) {
    runs[i] = madeRun("bc-" + std::to_string(i + 1), "whs", false);
    runs[i].status = i < 3 ? "iteration_limit" : "pnp_failed";
    runs[i].steps.resize(2);
    for (RunStep& step : runs[i].steps) step.error = PoseError{};
  }
  runs[0].iterations = 5;
  runs[2].steps.back().error->lateral_mm = 0.5;  // beyond 0.4 mm
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_DOUBLE_EQ(*figures.completed.percent(), 25.0);
  EXPECT_DOUBLE_EQ(*figures.success.percent(), 25.0);
  EXPECT_EQ(figures.at_limit, 2);
  EXPECT_DOUBLE_EQ(*figures.completed_with_limit.percent(), 75.0);
  EXPECT_DOUBLE_EQ(*figures.success_with_limit.percent(), 50.0);
  EXPECT_DOUBLE_EQ(figures.iterations.mean, 5.0) << "of completed runs";
}

TEST(MethodTimes, AreMeansOverRuns) {
  std::vector<RunResult> runs(4, madeRun("bc-1", "whs"));
  for (int i = 0; i < 4; ++i) runs[static_cast<std::size_t>(i)].seconds.matching = 1.0 + i * i;
  runs[1].seconds.pose = 2.0;
  runs.push_back(madeRun("bc-9", "whs", false));
  runs.back().status = "bad_seed";  // nothing was run
  const auto rows = methodTimes(runs);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].runs, 4);
  EXPECT_DOUBLE_EQ(rows[0].mean.matching, (1.0 + 2.0 + 5.0 + 10.0) / 4.0);
  EXPECT_DOUBLE_EQ(rows[0].mean.pose, 0.5);
  EXPECT_DOUBLE_EQ(rows[0].median_total, 4.5) << "of 1, 4, 5, 10";
  EXPECT_DOUBLE_EQ(rows[0].maximum_total, 10.0);
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(median({}), std::nullopt);
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
}

TEST(ErrorTable, ShowsThePapersRowsWithACautionWhenAsked) {
  const std::string without = tableText(errorTable(runsOfTwoMethods(), false), TableFormat::kText);
  EXPECT_THAT(without, Not(HasSubstr("paper")));
  const std::string with = tableText(errorTable(runsOfTwoMethods(), true), TableFormat::kText);
  EXPECT_THAT(with, HasSubstr("whs (paper)"));
  EXPECT_THAT(with, HasSubstr("0.083 / 0.036 / 0.232"));
  EXPECT_THAT(with, HasSubstr("compare errors, not success"));
  EXPECT_THAT(with, HasSubstr("10.1109/LRA.2025.3614045"));
  EXPECT_EQ(with.find("0.167 / 0.075"), std::string::npos) << "no OS among ours, none of theirs";
}

TEST(SuccessTable, ShowsThePapersFarRunsAxisByAxis) {
  const std::string csv = tableText(successTable(runsOfTwoMethods(), true), TableFormat::kCsv);
  EXPECT_THAT(csv, HasSubstr("Mars BC far 1.23 m,,loftr-r (paper),3,100,"));
  EXPECT_THAT(csv, HasSubstr(",66.7,100,0,\r\n"));
  EXPECT_THAT(csv, HasSubstr(",100,100,0,\r\n"));
}

TEST(ErrorTable, GivesThePapersSharesTheBoundsOf2000Runs) {
  const std::string csv = tableText(errorTable(runsOfTwoMethods(), true), TableFormat::kCsv);
  // Without failure: 0.05^(1 / 2000) = 0.998503.
  EXPECT_THAT(csv, testing::ContainsRegex("whs \\(paper\\),2000,2000,100,99\\.850[0-9]*,100,"));
}

std::string textOf(const Table& table) { return tableText(table, TableFormat::kText); }

TEST(SummaryTable, AddsUpTheStationsOfAMethod) {
  std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, 0.1, 0.1, 0.5),
                                 madeRun("os-1", "whs", true, 0.3, 0.1, 0.5),
                                 madeRun("os-2", "whs", false, 9.0, 0.1, 0.5)};
  runs[1].tags = {"far"};
  const std::string table = textOf(summaryTable(runs));
  EXPECT_THAT(table.substr(table.rfind("\nall")),
              AllOf(HasSubstr("66.7"), HasSubstr("0.200 / 0.100 / 0.300")));
  EXPECT_THAT(textOf(summaryTable(std::span(runs).first(1))), Not(HasSubstr("\nall")));
}

TEST(SummaryTable, CountsGrossFalsePositivesAndRefusedInputs) {
  std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, 0.5, 0.1, 0.5),
                                 madeRun("bc-2", "whs", true, -1.5, 0.1, 0.5),
                                 madeRun("bc-3", "whs", false)};
  runs[2].status = "input_error";
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_EQ(figures.runs, 2);
  EXPECT_EQ(figures.false_positives.count, 2);
  EXPECT_EQ(figures.gross_false_positives, 1);
  EXPECT_THAT(textOf(summaryTable(runs)), HasSubstr("1 runs could not start"));
}

TEST(SummaryTable, WithoutTruth_LeavesSuccessAndErrorsOpen) {
  RunResult blind = madeRun("bc-1", "whs");
  blind.error.reset();
  blind.seed_error.reset();
  blind.success.reset();
  const std::string table = textOf(summaryTable({&blind, 1}));
  EXPECT_THAT(table, AllOf(HasSubstr("100.0"), Not(HasSubstr("0.000"))));
}

TEST(ToleranceTable, GrowsWithTheTolerance) {
  const std::vector<RunResult> runs = {
      madeRun("bc-1", "whs", true, 0.03), madeRun("bc-2", "whs", true, 0.3),
      madeRun("bc-3", "whs", true, 0.7), madeRun("bc-4", "whs", false)};
  // 0.4 mm times 0.1, 0.25, 0.5, 1, 2, 3
  EXPECT_THAT(tableText(toleranceTable(runs), TableFormat::kCsv),
              HasSubstr("bc,near,whs,25,25,25,50,75,75"));
}

TEST(FailureList, NamesRunsThatWereNotSuccessful) {
  std::vector<RunResult> runs = {madeRun("bc-7", "whs", true, 0.1), madeRun("os-7", "whs", false)};
  runs[1].reseed = 4;
  runs[1].message = "no pose agrees";
  EXPECT_THAT(failureList(runs, 10), AllOf(HasSubstr("os-7 reseed 4: pnp_failed: no pose agrees"),
                                           Not(HasSubstr("bc-7"))));
  EXPECT_THAT(failureList(runs, 0), HasSubstr("1 more"));
}

TEST(Tables, HaveAsManyCellsAsColumns) {
  for (const bool paper : {false, true})
    for (const Table& table :
         {errorTable(runsOfTwoMethods(), paper), successTable(runsOfTwoMethods(), paper),
          toleranceTable(runsOfTwoMethods()), timeTable(runsOfTwoMethods()),
          strataTable(runsOfTwoMethods()), demonstrationTable(runsOfTwoMethods(), 0.9),
          flightTable({}, paper)})
      for (const auto& row : table.rows) {
        ASSERT_EQ(row.size(), table.columns.size()) << table.name;
        for (std::size_t i = 0; i < row.size(); ++i) {
          const bool text_of_parts = row[i].values.empty() && !table.columns[i].parts.empty();
          EXPECT_FALSE(text_of_parts) << table.name << ": CSV would lose columns";
        }
      }
}

}  // namespace
}  // namespace boresight::sessions
