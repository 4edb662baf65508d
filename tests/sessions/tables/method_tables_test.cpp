// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <cmath>

#include "sessions/tables/flight_table.h"
#include "sessions/tables/strata_table.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

std::string textOf(const Table& table) { return tableText(table, TableFormat::kText); }

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
  EXPECT_EQ(ncc.cases, 4);
  EXPECT_DOUBLE_EQ(*ncc.completed.percent(), 75.0);
  EXPECT_DOUBLE_EQ(*ncc.success.percent(), 25.0);
  EXPECT_EQ(ncc.false_positives.count, 2);
  EXPECT_DOUBLE_EQ(*ncc.false_positives.percent(), 50.0);
  EXPECT_EQ(ncc.gross_false_positives, 0);
  EXPECT_EQ(ncc.error[0].count, 3);
  EXPECT_NEAR(ncc.error[0].mean, 0.0, 1e-12);
  EXPECT_NEAR(ncc.error[0].deviation, std::sqrt((0.01 + 0.09 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(ncc.error[0].maximum, 0.3, 1e-12);
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
  EXPECT_THAT(textOf(summaryTable(runs)), HasSubstr("1 runs could not start"));
}

TEST(MethodFigures, CountGrossFalsePositivesBeyondThreeTimesTheRequirement) {
  const std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, 0.5, 0.1, 0.5),
                                       madeRun("bc-2", "whs", true, -1.5, 0.1, 0.5)};
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_EQ(figures.false_positives.count, 2);
  EXPECT_EQ(figures.gross_false_positives, 1);
}

TEST(MethodFigures, PosesFoundWithAWrongMesh_CountAsNoSuccessAnywhere) {
  std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, 0.01), madeRun("bc-2", "whs", false)};
  runs[1].status = "iteration_limit";
  runs[1].steps.resize(1);
  runs[1].steps[0].error = PoseError{};
  for (RunResult& run : runs) judge(true, run);
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_EQ(figures.gross_false_positives, 1);
  EXPECT_DOUBLE_EQ(*figures.success.percent(), 0.0);
  EXPECT_DOUBLE_EQ(*figures.success_with_limit.percent(), 0.0);
  EXPECT_DOUBLE_EQ(*figures.within_percent[0], 0.0);
  EXPECT_EQ(figures.error[0].count, 0);
  EXPECT_DOUBLE_EQ(*percentWithin(test::pointersTo(runs), 20.0), 0.0);
}

TEST(MethodFigures, StateBoundsOfClopperAndPearson) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 59; ++i) runs.push_back(madeRun("bc-" + std::to_string(i), "whs"));
  const MethodFigures figures = methodFigures(runs).back();
  // 59 images without a failure demonstrate 95 %: 0.05^(1 / 59) = 0.9505.
  EXPECT_NEAR(*figures.completed.leastPercent(), 95.05, 0.01);
  EXPECT_NEAR(*figures.success.leastPercent(), 95.05, 0.01);
  EXPECT_NEAR(*figures.false_positives.mostPercent(), 4.95, 0.01);
  EXPECT_DOUBLE_EQ(*figures.completed.mostPercent(), 100.0);
}

TEST(MethodFigures, RunsFromSeveralSeedsOfAnImage_AreOneTrialForTheBounds) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 590; ++i) {
    runs.push_back(madeRun("bc-" + std::to_string(i % 59), "whs"));
    runs.back().reseed = i / 59;
  }
  EXPECT_NEAR(*methodFigures(runs).back().success.leastPercent(), 95.05, 0.01);
  runs.back() = madeRun("bc-58", "whs", true, 9.0);  // one wrong pose of ten on the last image
  runs.back().reseed = 9;
  const MethodFigures figures = methodFigures(runs).back();
  EXPECT_EQ(figures.success.count, 589);
  EXPECT_EQ(figures.success.whole_images, 58);
  EXPECT_EQ(figures.false_positives.touched_images, 1);
  // scipy.stats.beta.ppf(0.05, 58, 2) and its complement.
  EXPECT_NEAR(*figures.success.leastPercent(), 92.21, 0.01);
  EXPECT_NEAR(*figures.false_positives.mostPercent(), 7.79, 0.01);
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
  EXPECT_THAT(textOf(errorTable(runsOfTwoMethods(), false)), Not(HasSubstr("paper")));
  EXPECT_THAT(textOf(errorTable(runsOfTwoMethods(), true)),
              AllOf(HasSubstr("whs (paper)"), HasSubstr("0.083 / 0.036 / 0.232"),
                    HasSubstr("compare errors, not success"), HasSubstr("10.1109/LRA.2025.3614045"),
                    Not(HasSubstr("0.167 / 0.075"))))
      << "no OS among ours, none of theirs";
  // The bounds are those of 2000 runs; without failure: 0.05^(1 / 2000) = 0.998503.
  EXPECT_THAT(test::csvOf(errorTable(runsOfTwoMethods(), true)),
              testing::ContainsRegex("whs \\(paper\\),2000,2000,100,99\\.850[0-9]*,100,"));
}

TEST(SuccessTable, ShowsThePapersFarRunsAxisByAxis) {
  EXPECT_THAT(test::csvOf(successTable(runsOfTwoMethods(), true)),
              AllOf(HasSubstr("Mars BC far 1.23 m,,loftr-r (paper),3,100,"),
                    HasSubstr(",66.7,100,0,\r\n"), HasSubstr(",100,100,0,\r\n")));
}

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

TEST(SummaryTable, WithoutTruth_LeavesSuccessAndErrorsOpen) {
  const RunResult blind = test::blindRun("bc-1");
  EXPECT_THAT(textOf(summaryTable({&blind, 1})),
              AllOf(HasSubstr("100.0"), Not(HasSubstr("0.000"))));
}

TEST(ToleranceTable, GrowsWithTheTolerance) {
  const std::vector<RunResult> runs = {
      madeRun("bc-1", "whs", true, 0.03), madeRun("bc-2", "whs", true, 0.3),
      madeRun("bc-3", "whs", true, 0.7), madeRun("bc-4", "whs", false)};
  // 0.4 mm times 0.1, 0.25, 0.5, 1, 2, 3
  EXPECT_THAT(test::csvOf(toleranceTable(runs)), HasSubstr("bc,near,whs,25,25,25,50,75,75"));
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
        for (std::size_t i = 0; i < row.size(); ++i)
          EXPECT_FALSE(row[i].values.empty() && !table.columns[i].parts.empty())
              << table.name << ": CSV would lose columns";
      }
}

RunResult taggedRun(const std::string& case_id, bool completed, std::vector<std::string> tags,
                    double distance_m) {
  RunResult run = madeRun(case_id, "whs", completed);
  run.tags = std::move(tags);
  run.camera_from_station_seed.translation_m = {0.0, 0.0, distance_m};
  return run;
}

TEST(StrataTable, CountsRunsByTagAndByDistance) {
  const std::vector<RunResult> runs = {
      taggedRun("bc-1", true, {"sun_low"}, 0.40),
      taggedRun("bc-2", false, {"sun_low"}, 0.41),
      taggedRun("bc-3", true, {"sun_high"}, 0.35),
      taggedRun("bc-4", true, {"sun_high", "hard", "hard_dusty"}, 0.36),
      taggedRun("bc-5", true, {"sun_high"}, 0.50),
      taggedRun("bc-6", false, {"sun_high"}, 0.51)};
  const std::string csv = test::csvOf(strataTable(runs));
  EXPECT_THAT(csv, AllOf(HasSubstr("sun,low,2,2,50,"), HasSubstr("sun,high,4,4,75,"),
                         HasSubstr("hard,dusty,1,1,100,"), HasSubstr("hard,none,5,5,60,"),
                         HasSubstr("distance,0.350 to 0.360 m,2,2,100,"),
                         HasSubstr("distance,0.500 to 0.510 m,2,2,50,"), Not(HasSubstr("sleeve"))));
}

TEST(StrataTable, RunWithTwoTagsOfAKind_IsInBothStrata) {
  const std::string csv = test::csvOf(strataTable(
      std::vector<RunResult>{taggedRun("bc-1", true, {"hard_dusty", "hard_shadow"}, 0.4),
                             taggedRun("bc-2", false, {"hard_dusty"}, 0.4)}));
  EXPECT_THAT(csv, AllOf(HasSubstr("hard,dusty,2,2,50,"), HasSubstr("hard,shadow,1,1,100,"),
                         Not(HasSubstr("hard,none"))));
}

TEST(StrataTable, KeepsStationsAndMethodsApart) {
  std::vector<RunResult> runs = {
      taggedRun("bc-1", true, {"sun_low"}, 0.4), taggedRun("bc-2", true, {"sun_high"}, 0.4),
      taggedRun("os-1", true, {"sun_low"}, 0.4), taggedRun("os-2", false, {"sun_high"}, 0.4)};
  runs[3].method = "ncc";
  const std::string csv = test::csvOf(strataTable(runs));
  EXPECT_THAT(csv, HasSubstr("bc,near,whs,sun,low,1,1,100"));
  EXPECT_THAT(csv, Not(HasSubstr("os,near,whs,sun"))) << "one group is no stratum";
}

TEST(DemonstrationTable, StatesRunsNeededAndMissing) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 60; ++i)
    runs.push_back(madeRun("bc-" + std::to_string(i), "whs", true, i == 7 ? 5.0 : 0.0));
  for (int i = 0; i < 59; ++i) runs.push_back(madeRun("os-" + std::to_string(i), "whs"));
  runs.push_back(madeRun("tu-1", "whs"));
  runs.back().success.reset();
  const std::string csv = test::csvOf(demonstrationTable(runs, 0.95));
  // Acceptance sampling: 59 without failure, 93 with one.
  EXPECT_THAT(csv, AllOf(HasSubstr("bc,near,whs,60,1,"), HasSubstr(",95,93,33"),
                         HasSubstr("os,near,whs,59,0,"), HasSubstr(",95,59,0")));
  EXPECT_THAT(csv, Not(HasSubstr("tu,"))) << "not judged";
}

InstructionCount countOf(const std::string& method, const std::string& station,
                         double minutes_of_matching) {
  InstructionCount count;
  count.method = method;
  count.station = station;
  count.case_id = station + "-1";
  count.matching = 12e9 * minutes_of_matching;  // 200 MHz for a minute
  return count;
}

TEST(FlightTable, AddsUpTheMeansOfStations) {
  const std::vector<InstructionCount> counts = {
      countOf("whs", "bc", 1.0), countOf("whs", "bc", 3.0), countOf("whs", "os", 5.0),
      countOf("ncc", "os", 0.5)};
  const std::string csv = tableText(flightTable(counts, false), TableFormat::kCsv);
  EXPECT_THAT(csv, HasSubstr("whs,bc + os,3,0,0,0,7,0,0,7"));
  EXPECT_THAT(csv, HasSubstr("ncc,os,1,0,0,0,0.5,0,0,0.5"));
  EXPECT_LT(csv.find("ncc"), csv.find("whs")) << "in the paper's order";
}

TEST(FlightTable, ShowsThePapersRowsWhenAsked) {
  const std::string text = tableText(flightTable({}, true), TableFormat::kText);
  EXPECT_THAT(text, HasSubstr("whs (paper)"));
  EXPECT_THAT(text, HasSubstr("21.330"));
  EXPECT_THAT(tableText(flightTable({}, false), TableFormat::kText), Not(HasSubstr("(paper)")));
}

TEST(InstructionCounts, AreReadAndRefusedWithTheirPlace) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& rendering) {
    return readInstructionCounts(
        folder.write("counts.json", R"({"format": "boresight-instructions", "version": 1, "runs": [
      {"method": "whs paper", "station": "bc", "case": "bc-1", "initialization": 1, "search": 2,
       "rendering": )" + rendering + R"(, "matching": 4, "pose": 5, "refinement": 6}]})"));
  };
  const std::vector<InstructionCount> counts = read("3");
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].method, "whs paper");
  EXPECT_DOUBLE_EQ(counts[0].total(), 21.0);
  EXPECT_THAT(folder.message([&] { read("-3"); }), HasSubstr("runs[0].rendering"));
}

}  // namespace
}  // namespace boresight::sessions
