// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/strata_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "sessions/tables/binomial_bounds.h"
#include "sessions/tables/method_tables.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

using Runs = std::vector<const RunResult*>;
/// The runs of one kind of stratum, by the stratum's name.
using Strata = std::vector<std::pair<std::string, Runs>>;

constexpr std::array<const char*, 3> kTagKinds = {"sun", "sleeve", "hard"};
constexpr const char* kNoTag = "none";
constexpr std::size_t kDistances = 3;

Strata strataByTag(const Runs& runs, const std::string& kind) {
  std::map<std::string, Runs> groups;
  for (const RunResult* run : runs) {
    bool tagged = false;
    for (const std::string& tag : run->tags) {  // a run with two tags of a kind is in both strata
      if (!tag.starts_with(kind + "_")) continue;
      tagged = true;
      groups[tag.substr(kind.size() + 1)].push_back(run);
    }
    if (!tagged) groups[kNoTag].push_back(run);
  }
  return {groups.begin(), groups.end()};
}

double seedDistance_m(const RunResult& run) {
  return run.camera_from_station_seed.translation_m.norm();
}

/// Groups of equal size, as far as the number of runs divides.
Strata strataByDistance(Runs runs) {
  std::stable_sort(runs.begin(), runs.end(), [](const RunResult* a, const RunResult* b) {
    return seedDistance_m(*a) < seedDistance_m(*b);
  });
  Strata strata;
  for (std::size_t i = 0; i < kDistances; ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(i * runs.size() / kDistances);
    const auto end = static_cast<std::ptrdiff_t>((i + 1) * runs.size() / kDistances);
    if (begin == end) continue;
    const Runs group(runs.begin() + begin, runs.begin() + end);
    strata.emplace_back(fixedText(seedDistance_m(*group.front()), 3) + " to " +
                            fixedText(seedDistance_m(*group.back()), 3) + " m",
                        group);
  }
  return strata;
}

void addStrata(const RunGroup& group, const std::string& kind, const Strata& strata, Table& table) {
  if (strata.size() < 2) return;
  for (const auto& [name, runs] : strata) {
    const MethodFigures figures = figuresOf(runs);
    table.rows.push_back({group.station, rangeText(group.far), group.method, kind, name,
                          figures.cases, figures.runs, leastCell(figures.completed),
                          leastCell(figures.success), mostCell(figures.false_positives)});
    for (const std::size_t column : {std::size_t{1}, std::size_t{2}}) {
      const Statistics& error = figures.error[column];
      table.rows.back().emplace_back(
          error.count == 0 ? std::vector<std::optional<double>>(2)
                           : std::vector<std::optional<double>>{error.mean, error.maximum});
    }
  }
}

}  // namespace

Table strataTable(std::span<const RunResult> runs) {
  Table table{"strata",
              "Runs by the conditions of their images",
              groupColumns({{"stratum"},
                            {"value"},
                            {"cases"},
                            {"runs"},
                            {"completed %", kLeast, 1},
                            {"success %", kLeast, 1},
                            {"false positives %", kMost, 1}}),
              {},
              {kBoundsNote}};
  for (const std::size_t column : {std::size_t{1}, std::size_t{2}})
    table.columns.push_back(
        {kErrorColumns[column].name, {"mean", "max"}, kErrorColumns[column].decimals});
  for (const RunGroup& group : runGroups(runs)) {
    for (const char* kind : kTagKinds) addStrata(group, kind, strataByTag(group.runs, kind), table);
    addStrata(group, "distance", strataByDistance(group.runs), table);
  }
  return table;
}

Table demonstrationTable(std::span<const RunResult> runs, double required) {
  Table table{
      "demonstration",
      "Success rate that the runs demonstrate",
      groupColumns({{"images"},
                    {"failed images"},
                    {"demonstrated %", {}, 2},
                    {"required %", {}, 2},
                    {"images needed"},
                    {"images missing"}}),
      {},
      {"Images needed: images that demonstrate the required rate with this number of failed "
       "ones, on which a run failed.",
       kBoundsNote}};
  for (const RunGroup& group : runGroups(runs)) {
    const CountedShare success = figuresOf(group.runs).success;
    if (success.runs == 0) continue;
    const std::int64_t failures = success.images - success.whole_images;
    const std::int64_t needed = runsNeeded(required, failures);
    table.rows.push_back({group.station, rangeText(group.far), group.method, success.images,
                          failures, success.leastPercent(), 100.0 * required, needed,
                          std::max<std::int64_t>(0, needed - success.images)});
  }
  return table;
}

}  // namespace boresight::sessions
