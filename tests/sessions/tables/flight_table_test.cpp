// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/flight_table.h"

#include <fstream>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;

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
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "counts.json";
  const auto write = [&](const std::string& rendering) {
    std::ofstream(file) << R"({"format": "boresight-instructions", "version": 1, "runs": [
      {"method": "whs paper", "station": "bc", "case": "bc-1", "initialization": 1, "search": 2,
       "rendering": )" << rendering
                        << R"(, "matching": 4, "pose": 5, "refinement": 6}]})";
  };
  write("3");
  const std::vector<InstructionCount> counts = readInstructionCounts(file);
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].method, "whs paper");
  EXPECT_DOUBLE_EQ(counts[0].total(), 21.0);
  write("-3");
  EXPECT_THAT(folder.message([&] { readInstructionCounts(file); }), HasSubstr("runs[0].rendering"));
}

}  // namespace
}  // namespace boresight::sessions
