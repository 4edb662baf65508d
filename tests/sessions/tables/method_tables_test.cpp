// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/sessions/tables/made_runs.h"

namespace boresight::sessions {
namespace {

using test::madeRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// By hand: NCC completes 3 of 4, of which one is beyond the lateral, one beyond the rotation.
std::vector<RunResult> sample() {
  return {madeRun("bc-1", "ncc", true, 0.1, 0.2, 1.0), madeRun("bc-2", "ncc", true, -0.3, 0.8, 3.0),
          madeRun("bc-3", "ncc", true, 0.2, 0.2, 5.0),
          madeRun("bc-4", "ncc", false, 9.0, 9.0, 90.0),
          madeRun("bc-1", "whs", true, 0.0, 0.1, 0.5)};
}

TEST(MethodFigures, AreThoseOfTheRuns) {
  const auto rows = methodFigures(sample());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].method, "seed");
  EXPECT_EQ(rows[0].runs, 4) << "each seed once, though two methods began from the first";
  EXPECT_DOUBLE_EQ(*rows[0].completed_percent, 100.0);
  EXPECT_DOUBLE_EQ(*rows[0].success_percent, 0.0);
  EXPECT_DOUBLE_EQ(rows[0].error[1].mean, 4.0);
  EXPECT_EQ(rows[0].false_positives, 0);

  const MethodFigures& ncc = rows[1];
  EXPECT_EQ(ncc.method, "ncc");
  EXPECT_EQ(ncc.runs, 4);
  EXPECT_DOUBLE_EQ(*ncc.completed_percent, 75.0);
  EXPECT_DOUBLE_EQ(*ncc.success_percent, 25.0);
  EXPECT_EQ(ncc.false_positives, 2);
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
  const std::string without = tableText(errorTable(sample(), false), TableFormat::kText);
  EXPECT_THAT(without, testing::Not(testing::HasSubstr("paper")));
  const std::string with = tableText(errorTable(sample(), true), TableFormat::kText);
  EXPECT_THAT(with, HasSubstr("whs (paper)"));
  EXPECT_THAT(with, HasSubstr("0.083 / 0.036 / 0.232"));
  EXPECT_THAT(with, HasSubstr("compare errors, not success"));
  EXPECT_THAT(with, HasSubstr("10.1109/LRA.2025.3614045"));
  EXPECT_EQ(with.find("0.167 / 0.075"), std::string::npos) << "no OS among ours, none of theirs";
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
  EXPECT_EQ(figures.false_positives, 2);
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
  EXPECT_THAT(tableText(toleranceTable(runs, false), TableFormat::kCsv),
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
    for (const Table& table : {errorTable(sample(), paper), successTable(sample(), paper),
                               toleranceTable(sample(), paper), timeTable(sample(), paper)})
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
