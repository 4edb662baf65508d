// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/flight_table.h"

#include <map>
#include <set>

#include "sessions/io/json/json_reader.h"
#include "sessions/tables/paper_figures.h"
#include "sessions/tables/results_set.h"

namespace boresight::sessions {
namespace {

constexpr double kInstructionsPerMinute = 200e6 * 60.0;
constexpr double kMostInstructions = 1e18;

/// Runs of one method on one station, added up.
struct Sum {
  InstructionCount counts;
  std::int64_t runs = 0;
};

InstructionCount readCount(const JsonReader& reader) {
  InstructionCount count;
  count.method = reader.at("method").nonEmptyText();
  count.station = reader.at("station").nonEmptyText();
  count.case_id = reader.at("case").nonEmptyText();
  for (const auto& [name, stage] : kCountedStages)
    count.*stage = reader.at(name).number(0.0, kMostInstructions);
  return count;
}

/// Minutes of a method: for each stage the sum of its stations' means.
InstructionCount minutesOf(const std::map<std::string, Sum>& stations) {
  InstructionCount minutes;
  for (const auto& [station, sum] : stations)
    for (const auto& [name, stage] : kCountedStages)
      minutes.*stage += sum.counts.*stage / static_cast<double>(sum.runs) / kInstructionsPerMinute;
  return minutes;
}

void addPaperTimes(Table& table) {
  for (const PaperTimes& row : kPaperTimes)
    table.rows.push_back({std::string(row.method) + " (paper)", "bc + os", std::nullopt,
                          row.initialization_min, std::nullopt, row.rendering_min, row.matching_min,
                          row.pose_min, std::nullopt, row.total_min});
  table.notes.push_back(
      std::string("Rows marked (paper): minutes measured on one core at 200 MHz; LoFTR from "
                  "another processor. Source: ") +
      kPaperSource + ".");
}

}  // namespace

double InstructionCount::total() const {
  double sum = 0.0;
  for (const auto& [name, stage] : kCountedStages) sum += this->*stage;
  return sum;
}

std::vector<InstructionCount> readInstructionCounts(const std::filesystem::path& file) {
  const JsonDocument document(file);
  return document.root().whole([](const JsonReader& root) {
    root.requireFormat("boresight-instructions", 1);
    std::vector<InstructionCount> counts;
    for (const JsonReader& run : root.at("runs").elements()) counts.push_back(readCount(run));
    return counts;
  });
}

Table flightTable(std::span<const InstructionCount> counts, bool with_paper) {
  Table table{"flight",
              "Minutes at 200 MHz, stations added up",
              {{"method"}, {"stations"}, {"runs"}},
              {},
              {"Counted instructions, one a cycle: a lower bound of the time."}};
  for (const auto& [name, stage] : kCountedStages) table.columns.push_back({name, {}, 3});
  table.columns.push_back({"total", {}, 3});
  std::map<std::string, std::map<std::string, Sum>, decltype(&methodBefore)> methods(&methodBefore);
  for (const InstructionCount& count : counts) {
    Sum& sum = methods[count.method][count.station];
    ++sum.runs;
    for (const auto& [name, stage] : kCountedStages) sum.counts.*stage += count.*stage;
  }
  for (const auto& [method, stations] : methods) {
    const InstructionCount minutes = minutesOf(stations);
    std::string names;
    std::int64_t runs = 0;
    for (const auto& [station, sum] : stations) {
      names += (names.empty() ? "" : " + ") + station;
      runs += sum.runs;
    }
    table.rows.push_back({method, names, runs});
    for (const auto& [name, stage] : kCountedStages) table.rows.back().emplace_back(minutes.*stage);
    table.rows.back().emplace_back(minutes.total());
  }
  if (with_paper) addPaperTimes(table);
  return table;
}

}  // namespace boresight::sessions
