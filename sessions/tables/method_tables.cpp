// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "sessions/tables/results_set.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

// What Pham 2025 (IEEE RA-L, DOI 10.1109/LRA.2025.3614045) reports, to be shown with our own.
constexpr const char* kPaperSource = "Pham et al., IEEE RA-L 2025, 10.1109/LRA.2025.3614045";
/// Shown wherever its success is listed with ours.
constexpr const char* kPaperCaution =
    "Rows marked (paper): 2000 synthetic images a station. The paper requires 0.4 mm and 0.25 deg "
    "(Sec. I), but its successful runs exceed both (Table I): compare errors, not success.";

/// mean, standard deviation, maximum
using PaperStatistics = std::array<double, 3>;

/// Synthetic images, near. Errors are all 0 where nothing completed.
struct PaperErrors {
  const char* station;
  const char* method;
  double completed_percent;
  double success_percent;
  PaperStatistics normal_mm;
  PaperStatistics lateral_mm;
  PaperStatistics rotation_mrad;
};

/// Minutes on a flight processor of 200 MHz, BC and OS added up.
struct PaperTimes {
  const char* method;
  double initialization_min;
  double rendering_min;
  double matching_min;
  double pose_min;
  double total_min;
};

/// Real images; percent by kSuccessMethods.
constexpr std::array<const char*, 6> kSuccessMethods = {"orb",     "ssd",     "ncc",
                                                        "loftr-r", "loftr-s", "whs"};
struct PaperSuccess {
  const char* set;
  int runs;
  std::array<double, 6> completed_percent;
  std::array<double, 6> success_percent;
};

constexpr PaperErrors kErrors[] = {
    {"bc", "seed", 100, 0, {-0.095, 12.73, 19.92}, {16.94, 8.853, 29.99}, {48.86, 26.32, 86.92}},
    {"bc", "orb", 0, 0, {}, {}, {}},
    {"bc", "ssd", 2.1, 0.9, {8.179, 23.76, 93.76}, {21.97, 38.31, 142.2}, {193.3, 196.8, 593.4}},
    {"bc", "ncc", 94.3, 94.0, {-0.062, 1.153, 23.60}, {0.177, 1.511, 57.30}, {2.512, 15.78, 330.9}},
    {"bc",
     "loftr-r",
     100,
     98.0,
     {-0.174, 0.324, 2.009},
     {0.156, 0.153, 1.332},
     {3.936, 3.782, 37.95}},
    {"bc",
     "loftr-s",
     99.5,
     91.0,
     {-0.205, 1.421, 5.842},
     {0.318, 1.792, 74.83},
     {7.232, 12.24, 351.3}},
    {"bc", "whs", 100, 100, {0.005, 0.082, 0.446}, {0.083, 0.036, 0.232}, {1.143, 0.708, 6.477}},
    {"os", "seed", 100, 1.1, {-0.054, 7.321, 11.45}, {7.906, 4.131, 14.00}, {17.13, 9.225, 30.47}},
    {"os", "orb", 45.6, 21.1, {0.107, 2.060, 14.63}, {0.846, 0.916, 7.278}, {25.12, 25.33, 148.9}},
    {"os", "ssd", 43.6, 43.6, {0.159, 0.185, 0.865}, {0.163, 0.072, 0.494}, {2.707, 1.673, 11.52}},
    {"os", "ncc", 98.7, 98.7, {0.146, 0.150, 1.053}, {0.162, 0.064, 0.494}, {2.206, 1.367, 9.351}},
    {"os",
     "loftr-r",
     95.0,
     22.3,
     {0.059, 1.699, 7.662},
     {0.917, 0.907, 31.99},
     {27.21, 15.11, 109.3}},
    {"os",
     "loftr-s",
     51.1,
     6.6,
     {-1.103, 7.535, 54.16},
     {5.085, 11.69, 71.67},
     {31.81, 22.02, 157.4}},
    {"os", "whs", 100, 100, {0.012, 0.208, 1.213}, {0.167, 0.075, 0.590}, {2.725, 1.737, 13.20}},
};

constexpr PaperTimes kTimes[] = {
    {"orb", 1.13, 7.40, 0.60, 2.66, 11.79},          {"ssd", 1.11, 7.49, 3.73, 1.67, 14.00},
    {"ncc", 1.12, 7.11, 3.61, 0.38, 12.22},          {"loftr-r", 1.35, 8.08, 671.26, 0.69, 681.38},
    {"loftr-s", 1.23, 7.70, 2146.98, 4.65, 2160.56}, {"whs", 1.22, 6.91, 13.17, 0.02, 21.33},
};

constexpr PaperSuccess kSuccess[] = {
    {"testbed OS", 20, {0, 100, 100, 70, 10, 100}, {0, 45, 45, 5, 0, 100}},
    {"testbed BC", 20, {0, 40, 65, 100, 100, 100}, {0, 0, 0, 95, 95, 100}},
    {"Mars BC near 0.49 m", 3, {0, 0, 33.3, 100, 66.7, 100}, {0, 0, 0, 100, 0, 100}},
    {"Mars BC far 1.23 m", 3, {0, 0, 0, 100, 33.3, 100}, {0, 0, 0, 0, 0, 0}},
};

constexpr const char* kSeed = "seed";

using Members = std::vector<const RunResult*>;

std::optional<double> percent(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Percent of completed runs within the requirement of one figure, of runs whose requirement names
/// it.
std::optional<double> percentWithinFigure(const Members& members, const JudgedFigure& figure) {
  std::int64_t asked = 0;
  std::int64_t met = 0;
  for (const RunResult* run : members) {
    if (!run->success || !run->error || !run->requirement) continue;
    const std::optional<double> limit = (*run->requirement).*figure.limit;
    if (!limit) continue;
    const std::optional<double> value = figure.error(*run->error);
    ++asked;
    met += run->completed && value && std::abs(*value) <= *limit ? 1 : 0;
  }
  return percent(met, asked);
}

Statistics errorStatistics(const Members& members, const ErrorColumn& column) {
  std::vector<double> values;
  for (const RunResult* run : members)
    if (const auto value = run->completed && run->error ? column.of(*run->error) : std::nullopt)
      values.push_back(*value);
  return statistics(values);
}

MethodFigures figuresOf(const Members& members) {
  MethodFigures figures;
  std::int64_t completed = 0;
  std::int64_t judged = 0;
  std::int64_t successful = 0;
  for (const RunResult* run : members) {
    ++figures.runs;
    completed += run->completed ? 1 : 0;
    judged += run->success.has_value() ? 1 : 0;
    successful += run->success.value_or(false) ? 1 : 0;
    figures.false_positives += run->false_positive ? 1 : 0;
    figures.gross_false_positives += run->gross_false_positive ? 1 : 0;
  }
  figures.completed_percent = percent(completed, figures.runs);
  figures.success_percent = percent(successful, judged);
  for (std::size_t i = 0; i < kJudgedFigures.size(); ++i)
    figures.within_percent[i] = percentWithinFigure(members, kJudgedFigures[i]);
  for (std::size_t i = 0; i < kErrorColumns.size(); ++i)
    figures.error[i] = errorStatistics(members, kErrorColumns[i]);
  return figures;
}

/// The seeds of runs, each once, as if each were what a run had ended with.
std::vector<RunResult> seedsOf(std::span<const RunResult> runs) {
  std::set<std::tuple<std::string, std::string, std::int32_t>> seen;
  std::vector<RunResult> seeds;
  for (const RunResult& run : runs) {
    if (run.inputFailed() || !run.seed_error ||
        !seen.insert({run.station, run.case_id, run.reseed}).second)
      continue;
    RunResult seed;
    seed.case_id = run.case_id;
    seed.station = run.station;
    seed.tags = run.tags;
    seed.method = kSeed;
    seed.completed = true;
    seed.error = run.seed_error;
    seed.requirement = run.requirement;
    judge(false, seed);
    seed.false_positive = seed.gross_false_positive = false;  // a seed claims nothing
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

using Parts = std::vector<std::optional<double>>;
const Parts kNoParts(3);

Parts statisticsCell(const Statistics& figures) {
  return figures.count == 0 ? kNoParts : Parts{figures.mean, figures.deviation, figures.maximum};
}

Parts statisticsCell(const PaperStatistics& figures, bool any) {
  return any ? Parts{figures[0], figures[1], figures[2]} : kNoParts;
}

std::string rangeText(bool far) { return far ? "far" : "near"; }

struct GroupKey {
  std::string station;
  bool far = false;
  std::string method;

  bool operator<(const GroupKey& other) const {
    if (std::tie(station, far) != std::tie(other.station, other.far))
      return std::tie(station, far) < std::tie(other.station, other.far);
    return methodBefore(method, other.method);
  }
};

/// By station, near before far, and method. Runs whose input was refused are left out.
std::map<GroupKey, Members> membersByGroup(std::span<const RunResult> runs) {
  std::map<GroupKey, Members> groups;
  for (const RunResult& run : runs)
    if (!run.inputFailed()) groups[{run.station, run.hasTag(kFarTag), run.method}].push_back(&run);
  return groups;
}

std::string paperName(const std::string& method) { return method + " (paper)"; }

std::vector<std::vector<TableCell>> paperErrorRows(const std::string& station) {
  std::vector<std::vector<TableCell>> rows;
  for (const PaperErrors& row : kErrors) {
    if (row.station != station) continue;
    const bool any = row.completed_percent > 0.0;
    rows.push_back({row.station, "near", paperName(row.method), "2000", row.completed_percent,
                    row.success_percent, std::nullopt, std::nullopt,
                    statisticsCell(row.normal_mm, any), statisticsCell(row.lateral_mm, any),
                    statisticsCell(row.rotation_mrad, any), kNoParts});
  }
  return rows;
}

}  // namespace

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

const std::array<ErrorColumn, 4> kErrorColumns = {{
    {"normal mm", 3, [](const PoseError& e) { return std::optional(e.normal_mm); }},
    {"lateral mm", 3, [](const PoseError& e) { return std::optional(e.lateral_mm); }},
    {"rotation mrad", 3, [](const PoseError& e) { return std::optional(e.rotation_mrad); }},
    {"projection px", 2, [](const PoseError& e) { return e.projection_px; }},
}};

std::vector<MethodFigures> methodFigures(std::span<const RunResult> runs) {
  const std::vector<RunResult> seeds = seedsOf(runs);
  std::map<GroupKey, Members> groups = membersByGroup(runs);
  groups.merge(membersByGroup(seeds));
  std::vector<MethodFigures> rows;
  for (const auto& [key, members] : groups) {
    rows.push_back(figuresOf(members));
    rows.back().station = key.station;
    rows.back().far = key.far;
    rows.back().method = key.method;
  }
  return rows;
}

std::optional<double> percentWithin(std::span<const RunResult* const> runs, double factor) {
  std::int64_t judged = 0;
  std::int64_t within = 0;
  for (const RunResult* run : runs) {
    if (!run->success || !run->error || !run->requirement) continue;
    ++judged;
    within += run->completed && meetsRequirement(*run->error, *run->requirement, factor) ? 1 : 0;
  }
  return percent(within, judged);
}

std::vector<MethodTimes> methodTimes(std::span<const RunResult> runs) {
  std::map<std::string, Members, decltype(&methodBefore)> groups(&methodBefore);
  for (const RunResult& run : runs)
    if (!run.inputFailed() && run.status != "bad_seed") groups[run.method].push_back(&run);
  std::vector<MethodTimes> rows;
  for (const auto& [method, members] : groups) {
    MethodTimes times;
    times.method = method;
    times.runs = static_cast<std::int64_t>(members.size());
    std::vector<double> totals;
    for (const RunResult* run : members) {
      times.mean += run->seconds;
      totals.push_back(run->seconds.total());
    }
    for (const auto& [name, part] : kStages)
      times.mean.*part /= static_cast<double>(members.size());
    times.median_total = median(totals).value_or(0.0);
    times.maximum_total = *std::max_element(totals.begin(), totals.end());
    rows.push_back(std::move(times));
  }
  return rows;
}

Table errorTable(std::span<const RunResult> runs, bool with_paper) {
  Table table{"errors",
              "Errors per station and method, over completed runs",
              {{"station"},
               {"range"},
               {"method"},
               {"runs"},
               {"completed %", {}, 1},
               {"success %", {}, 1},
               {"false positives"},
               {"gross"}},
              {},
              {"Errors are those of the end effector, or of the camera where a case has none.",
               "The maximum of the normal error is that of its absolute value."}};
  for (const ErrorColumn& column : kErrorColumns)
    table.columns.push_back({column.name, {"mean", "std", "max"}, column.decimals});
  std::string station;
  for (const MethodFigures& row : methodFigures(runs)) {
    if (with_paper && row.station != station)
      for (auto& paper_row : paperErrorRows(row.station))
        table.rows.push_back(std::move(paper_row));
    station = row.station;
    const bool judged = row.method != kSeed && row.success_percent;
    table.rows.push_back({row.station, rangeText(row.far), row.method, row.runs,
                          row.completed_percent, row.success_percent,
                          judged ? TableCell(row.false_positives) : TableCell(std::nullopt),
                          judged ? TableCell(row.gross_false_positives) : TableCell(std::nullopt)});
    for (const Statistics& figures : row.error)
      table.rows.back().emplace_back(statisticsCell(figures));
  }
  const auto refused = std::count_if(runs.begin(), runs.end(),
                                     [](const RunResult& run) { return run.inputFailed(); });
  if (refused > 0)
    table.notes.push_back(std::to_string(refused) +
                          " runs could not start: their input was refused.");
  if (with_paper) {
    table.notes.emplace_back(kPaperCaution);
    table.notes.push_back(std::string("Source: ") + kPaperSource + ".");
  }
  return table;
}

Table summaryTable(std::span<const RunResult> runs) {
  Table table = errorTable(runs, false);
  std::vector<RunResult> all(runs.begin(), runs.end());
  for (RunResult& run : all) {
    run.station = "all";
    run.tags.clear();
  }
  Table sums = errorTable(all, false);
  for (auto& row : sums.rows) row[1] = "";  // near and far together
  if (table.rows.size() > sums.rows.size())
    table.rows.insert(table.rows.end(), sums.rows.begin(), sums.rows.end());
  return table;
}

Table successTable(std::span<const RunResult> runs, bool with_paper) {
  Table table{
      "success",
      "Completed and successful runs, percent",
      {{"station"}, {"range"}, {"method"}, {"runs"}, {"completed %", {}, 1}, {"success %", {}, 1}},
      {},
      {"Within: completed and within what the requirement says of that error alone."}};
  for (const char* name : {"normal", "lateral", "rotation", "projection"})
    table.columns.push_back({std::string("within ") + name + " %", {}, 1});
  for (const MethodFigures& row : methodFigures(runs)) {
    if (row.method == kSeed) continue;
    table.rows.push_back({row.station, rangeText(row.far), row.method, row.runs,
                          row.completed_percent, row.success_percent});
    for (const auto& within : row.within_percent) table.rows.back().emplace_back(within);
  }
  if (!with_paper) return table;
  for (const PaperSuccess& row : kSuccess)
    for (std::size_t i = 0; i < kSuccessMethods.size(); ++i)
      table.rows.push_back({row.set, "", paperName(kSuccessMethods[i]), std::int64_t{row.runs},
                            row.completed_percent[i], row.success_percent[i], std::nullopt,
                            std::nullopt, std::nullopt, std::nullopt});
  table.notes.push_back(std::string("Rows marked (paper) are of other images, cameras and "
                                    "requirements: they cannot be compared with ours. Source: ") +
                        kPaperSource + ".");
  return table;
}

Table toleranceTable(std::span<const RunResult> runs, bool) {
  constexpr std::array<double, 6> kFactors = {0.1, 0.25, 0.5, 1.0, 2.0, 3.0};
  Table table{"tolerance",
              "Success, percent, against multiples of the requirement",
              {{"station"}, {"range"}, {"method"}},
              {},
              {}};
  for (const double factor : kFactors)
    table.columns.push_back({fixedText(factor, 2) + " x", {}, 1});
  for (const auto& [key, members] : membersByGroup(runs)) {
    table.rows.push_back({key.station, rangeText(key.far), key.method});
    for (const double factor : kFactors)
      table.rows.back().emplace_back(percentWithin(members, factor));
  }
  return table;
}

Table timeTable(std::span<const RunResult> runs, bool with_paper) {
  Table table{"times",
              "Time per run and step, seconds",
              {{"method"}, {"runs"}},
              {},
              {"Means of wall time; median and maximum are of a run's total."}};
  for (const auto& [name, part] : kStages) table.columns.push_back({name, {}, 3});
  for (const char* name : {"total", "median", "maximum"}) table.columns.push_back({name, {}, 3});
  for (const MethodTimes& row : methodTimes(runs)) {
    table.rows.push_back({row.method, row.runs});
    for (const auto& [name, part] : kStages) table.rows.back().emplace_back(row.mean.*part);
    for (const double seconds : {row.mean.total(), row.median_total, row.maximum_total})
      table.rows.back().emplace_back(seconds);
  }
  if (!with_paper) return table;
  for (const PaperTimes& row : kTimes)
    table.rows.push_back({paperName(row.method), "2", 60.0 * row.initialization_min,
                          60.0 * row.rendering_min, 60.0 * row.matching_min, 60.0 * row.pose_min,
                          std::nullopt, 60.0 * row.total_min, std::nullopt, std::nullopt});
  table.notes.push_back(
      std::string("Rows marked (paper) are of one core at 200 MHz, a BC and an OS "
                  "case added up. Source: ") +
      kPaperSource + ".");
  return table;
}

std::string failureList(std::span<const RunResult> results, std::size_t limit) {
  std::string text;
  std::size_t count = 0;
  for (const RunResult& result : results) {
    if (result.inputFailed() || result.success.value_or(true)) continue;
    if (++count > limit) continue;
    std::string line = "  " + result.case_id +
                       (result.reseed > 0 ? " reseed " + std::to_string(result.reseed) : "") +
                       ": " + result.status;
    if (result.completed && result.error)
      line += ", normal " + fixedText(result.error->normal_mm, 3) + " mm, lateral " +
              fixedText(result.error->lateral_mm, 3) + " mm, rotation " +
              fixedText(result.error->rotation_mrad, 2) + " mrad";
    if (result.completed && result.error && result.error->projection_px)
      line += ", " + fixedText(*result.error->projection_px, 1) + " px";
    if (!result.message.empty()) line += ": " + result.message;
    text += plainLine(line);
  }
  if (count > limit) text += "  and " + std::to_string(count - limit) + " more\n";
  return count > 0 ? "not successful:\n" + text : "";
}

}  // namespace boresight::sessions
