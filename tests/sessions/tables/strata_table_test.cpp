// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/strata_table.h"

#include "tests/sessions/tables/made_runs.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

std::string csvOf(const Table& table) { return tableText(table, TableFormat::kCsv); }

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
  const std::string csv = csvOf(strataTable(runs));
  EXPECT_THAT(csv, AllOf(HasSubstr("sun,low,2,2,50,"), HasSubstr("sun,high,4,4,75,"),
                         HasSubstr("hard,dusty,1,1,100,"), HasSubstr("hard,none,5,5,60,"),
                         HasSubstr("distance,0.350 to 0.360 m,2,2,100,"),
                         HasSubstr("distance,0.500 to 0.510 m,2,2,50,")));
  EXPECT_THAT(csv, Not(HasSubstr("sleeve"))) << "no run has such a tag";
}

TEST(StrataTable, KeepsStationsAndMethodsApart) {
  std::vector<RunResult> runs = {
      taggedRun("bc-1", true, {"sun_low"}, 0.4), taggedRun("bc-2", true, {"sun_high"}, 0.4),
      taggedRun("os-1", true, {"sun_low"}, 0.4), taggedRun("os-2", false, {"sun_high"}, 0.4)};
  runs[3].method = "ncc";
  const std::string csv = csvOf(strataTable(runs));
  EXPECT_THAT(csv, HasSubstr("bc,near,whs,sun,low,1,1,100"));
  EXPECT_THAT(csv, Not(HasSubstr("os,near,whs,sun"))) << "one group is no stratum";
}

TEST(DemonstrationTable, StatesRunsNeededAndMissing) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 60; ++i)
    runs.push_back(madeRun("bc-" + std::to_string(i), "whs", true, i == 7 ? 5.0 : 0.0));
  for (int i = 0; i < 59; ++i) runs.push_back(madeRun("os-" + std::to_string(i), "whs"));
  RunResult blind = madeRun("tu-1", "whs");
  blind.success.reset();
  runs.push_back(blind);
  const std::string csv = csvOf(demonstrationTable(runs, 0.95));
  // Acceptance sampling: 59 without failure, 93 with one.
  EXPECT_THAT(csv, AllOf(HasSubstr("bc,near,whs,60,1,"), HasSubstr(",95,93,33"),
                         HasSubstr("os,near,whs,59,0,"), HasSubstr(",95,59,0")));
  EXPECT_THAT(csv, Not(HasSubstr("tu,"))) << "not judged";
}

}  // namespace
}  // namespace boresight::sessions
