// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "sessions/tables/binomial_bounds.h"
#include "sessions/tables/paper_figures.h"
#include "sessions/tables/results_set.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr const char* kSeed = "seed";

using RunSpan = std::span<const RunResult* const>;

std::optional<double> percentOf(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Percent of completed runs within the requirement of one figure, of runs whose requirement names
/// it.
std::optional<double> percentWithinFigure(RunSpan members, const JudgedFigure& figure) {
  std::int64_t asked = 0;
  std::int64_t met = 0;
  for (const RunResult* run : members) {
    if (!run->success || !run->error || !run->requirement) continue;
    const std::optional<double> limit = (*run->requirement).*figure.limit;
    if (!limit) continue;
    const std::optional<double> value = figure.error(*run->error);
    ++asked;
    met += run->completedError() && value && std::abs(*value) <= *limit ? 1 : 0;
  }
  return percentOf(met, asked);
}

Statistics errorStatistics(RunSpan members, const ErrorColumn& column) {
  std::vector<double> values;
  for (const RunResult* run : members)
    if (const PoseError* error = run->completedError())
      if (const auto value = column.of(*error)) values.push_back(*value);
  return statistics(values);
}

bool endedAtLimit(const RunResult& run) {
  return run.status == localizationStatusText(LocalizationStatus::kIterationLimit);
}

/// The last pose of a run that ended at the limit of iterations, judged as if it had completed.
bool succeedsAtLimit(const RunResult& run) {
  return endedAtLimit(run) && !run.wrong_mesh && run.requirement && !run.steps.empty() &&
         run.steps.back().error && meetsRequirement(*run.steps.back().error, *run.requirement);
}

/// An image of a dataset: cases of several datasets may share an id.
std::pair<std::string, std::string> imageOf(const RunResult& run) {
  return {run.case_id, run.inputs_sha256};
}

/// The share of the runs that count.
template <class Counts>
CountedShare shareOf(const std::vector<const RunResult*>& runs, Counts counts) {
  CountedShare share;
  std::map<std::pair<std::string, std::string>, std::pair<bool, bool>> images;  // all, any
  for (const RunResult* run : runs) {
    const bool counted = counts(*run);
    ++share.runs;
    share.count += counted ? 1 : 0;
    auto& [all, any] = images.try_emplace(imageOf(*run), true, false).first->second;
    all = all && counted;
    any = any || counted;
  }
  share.images = static_cast<std::int64_t>(images.size());
  for (const auto& [image, ends] : images) {
    share.whole_images += ends.first ? 1 : 0;
    share.touched_images += ends.second ? 1 : 0;
  }
  return share;
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

const Parts kNoShare(2);

/// The count of runs that the paper states as a percentage; an image each.
CountedShare paperShare(double percent, int runs) {
  const std::int64_t count = std::llround(0.01 * percent * runs);
  return {count, runs, runs, count, count};
}

std::string paperName(const std::string& method) { return method + " (paper)"; }

std::vector<std::vector<TableCell>> paperErrorRows(const std::string& station) {
  constexpr int kRuns = 2000;
  std::vector<std::vector<TableCell>> rows;
  for (const PaperErrors& row : paperErrors(station)) {
    const bool any = row.completed_percent > 0.0;
    const bool is_seed = std::string(row.method) == kSeed;
    const CountedShare wrong = paperShare(row.completed_percent - row.success_percent, kRuns);
    rows.push_back({station, "near", paperName(row.method), std::int64_t{kRuns},
                    std::int64_t{kRuns}, leastCell(paperShare(row.completed_percent, kRuns)),
                    leastCell(paperShare(row.success_percent, kRuns)),
                    is_seed ? kNoShare : mostCell(wrong), std::nullopt, kNoShare,
                    statisticsCell(row.normal_mm, any), statisticsCell(row.lateral_mm, any),
                    statisticsCell(row.rotation_mrad, any), kNoParts});
  }
  return rows;
}

std::vector<TableCell> errorRow(const MethodFigures& row) {
  const bool is_seed = row.method == kSeed;
  const bool judged = !is_seed && row.success.runs > 0;
  std::vector<TableCell> cells = {
      row.station,
      rangeText(row.far),
      row.method,
      row.cases,
      row.runs,
      leastCell(row.completed),
      leastCell(row.success),
      judged ? mostCell(row.false_positives) : kNoShare,
      judged ? TableCell(row.gross_false_positives) : TableCell(std::nullopt),
      is_seed || row.iterations.count == 0 ? kNoShare
                                           : Parts{row.iterations.mean, row.iterations.maximum}};
  for (const Statistics& figures : row.error) cells.emplace_back(statisticsCell(figures));
  return cells;
}

/// A paper's row for each method of a set of real images.
void addPaperSuccess(const PaperSuccess& set, Table& table) {
  for (std::size_t i = 0; i < kPaperMethods.size(); ++i) {
    table.rows.push_back({set.set, "", paperName(kPaperMethods[i]), std::int64_t{set.runs},
                          leastCell(paperShare(set.completed_percent[i], set.runs)),
                          leastCell(paperShare(set.success_percent[i], set.runs)), std::nullopt,
                          std::nullopt, std::nullopt});
    for (std::size_t figure = 0; figure < 3; ++figure)
      table.rows.back().emplace_back(
          set.within_percent ? std::optional((*set.within_percent)[i][figure]) : std::nullopt);
    table.rows.back().emplace_back(std::nullopt);  // the projection
  }
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

std::vector<std::optional<double>> leastCell(const CountedShare& share) {
  return {share.percent(), share.leastPercent()};
}

std::vector<std::optional<double>> mostCell(const CountedShare& share) {
  return {share.percent(), share.mostPercent()};
}

std::optional<double> CountedShare::percent() const { return percentOf(count, runs); }

std::optional<double> CountedShare::leastPercent() const {
  if (runs == 0) return std::nullopt;
  return 100.0 * lowerBound(whole_images, images);
}

std::optional<double> CountedShare::mostPercent() const {
  if (runs == 0) return std::nullopt;
  return 100.0 * upperBound(touched_images, images);
}

std::vector<TableColumn> groupColumns(const std::vector<TableColumn>& further) {
  std::vector<TableColumn> columns = {{"station"}, {"range"}, {"method"}};
  columns.insert(columns.end(), further.begin(), further.end());
  return columns;
}

const char* rangeText(bool far) { return far ? "far" : "near"; }

namespace {

std::vector<RunGroup> groupsOf(RunSpan runs) {
  std::map<GroupKey, std::vector<const RunResult*>> groups;
  for (const RunResult* run : runs)
    if (!run->inputFailed())
      groups[{run->station, run->hasTag(kFarTag), run->method}].push_back(run);
  std::vector<RunGroup> listed;
  for (auto& [key, members] : groups)
    listed.push_back({key.station, key.far, key.method, std::move(members)});
  return listed;
}

void addPointers(std::span<const RunResult> runs, std::vector<const RunResult*>& pointers) {
  for (const RunResult& run : runs) pointers.push_back(&run);
}

}  // namespace

std::vector<RunGroup> runGroups(std::span<const RunResult> runs) {
  std::vector<const RunResult*> all;
  addPointers(runs, all);
  return groupsOf(all);
}

MethodFigures figuresOf(std::span<const RunResult* const> runs) {
  MethodFigures figures;
  std::set<std::string> cases;
  std::vector<double> iterations;
  std::vector<const RunResult*> judged;
  for (const RunResult* run : runs) {
    cases.insert(run->case_id);
    figures.at_limit += endedAtLimit(*run) ? 1 : 0;
    figures.gross_false_positives += run->gross_false_positive ? 1 : 0;
    if (run->completed) iterations.push_back(run->iterations);
    if (run->success) judged.push_back(run);
  }
  figures.runs = static_cast<std::int64_t>(runs.size());
  figures.cases = static_cast<std::int64_t>(cases.size());
  const std::vector<const RunResult*> all(runs.begin(), runs.end());
  figures.completed = shareOf(all, [](const RunResult& run) { return run.completed; });
  figures.completed_with_limit =
      shareOf(all, [](const RunResult& run) { return run.completed || endedAtLimit(run); });
  figures.success = shareOf(judged, [](const RunResult& run) { return *run.success; });
  figures.false_positives =
      shareOf(judged, [](const RunResult& run) { return run.false_positive; });
  figures.success_with_limit =
      shareOf(judged, [](const RunResult& run) { return *run.success || succeedsAtLimit(run); });
  figures.iterations = statistics(iterations);
  for (std::size_t i = 0; i < kJudgedFigures.size(); ++i)
    figures.within_percent[i] = percentWithinFigure(runs, kJudgedFigures[i]);
  for (std::size_t i = 0; i < kErrorColumns.size(); ++i)
    figures.error[i] = errorStatistics(runs, kErrorColumns[i]);
  return figures;
}

std::vector<MethodFigures> methodFigures(std::span<const RunResult> runs) {
  const std::vector<RunResult> seeds = seedsOf(runs);
  std::vector<const RunResult*> all;
  addPointers(seeds, all);
  addPointers(runs, all);
  std::vector<MethodFigures> rows;
  for (const RunGroup& group : groupsOf(all)) {
    rows.push_back(figuresOf(group.runs));
    rows.back().station = group.station;
    rows.back().far = group.far;
    rows.back().method = group.method;
  }
  return rows;
}

std::optional<double> percentWithin(std::span<const RunResult* const> runs, double factor) {
  std::int64_t judged = 0;
  std::int64_t within = 0;
  for (const RunResult* run : runs) {
    if (!run->success || !run->error || !run->requirement) continue;
    ++judged;
    const PoseError* error = run->completedError();
    within += error != nullptr && meetsRequirement(*error, *run->requirement, factor) ? 1 : 0;
  }
  return percentOf(within, judged);
}

std::vector<MethodTimes> methodTimes(std::span<const RunResult> runs) {
  std::map<std::string, std::vector<const RunResult*>, decltype(&methodBefore)> groups(
      &methodBefore);
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
              groupColumns({{"cases"},
                            {"runs"},
                            {"completed %", kLeast, 1},
                            {"success %", kLeast, 1},
                            {"false positives %", kMost, 1},
                            {"gross"},
                            {"iterations", {"mean", "max"}, 1}}),
              {},
              {"Errors are those of the end effector, or of the camera where a case has none.",
               "The maximum of the normal error is that of its absolute value.", kBoundsNote}};
  for (const ErrorColumn& column : kErrorColumns)
    table.columns.push_back({column.name, {"mean", "std", "max"}, column.decimals});
  std::string station;
  for (const MethodFigures& row : methodFigures(runs)) {
    if (with_paper && row.station != station)
      for (auto& paper_row : paperErrorRows(row.station))
        table.rows.push_back(std::move(paper_row));
    station = row.station;
    table.rows.push_back(errorRow(row));
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
  Table table{"success",
              "Completed and successful runs, percent",
              groupColumns({{"runs"},
                            {"completed %", kLeast, 1},
                            {"success %", kLeast, 1},
                            {"at limit"},
                            {"completed % with limit", {}, 1},
                            {"success % with limit", {}, 1}}),
              {},
              {"Within: completed and within what the requirement says of that error alone.",
               "With limit: runs that ended at the limit of iterations count with their last pose.",
               kBoundsNote}};
  for (const char* name : {"normal", "lateral", "rotation", "projection"})
    table.columns.push_back({std::string("within ") + name + " %", {}, 1});
  for (const MethodFigures& row : methodFigures(runs)) {
    if (row.method == kSeed) continue;
    table.rows.push_back({row.station, rangeText(row.far), row.method, row.runs,
                          leastCell(row.completed), leastCell(row.success), row.at_limit,
                          row.completed_with_limit.percent(), row.success_with_limit.percent()});
    for (const auto& within : row.within_percent) table.rows.back().emplace_back(within);
  }
  if (!with_paper) return table;
  for (const PaperSuccess& set : kPaperSuccess) addPaperSuccess(set, table);
  table.notes.push_back(std::string("Rows marked (paper) are of other images, cameras and "
                                    "requirements: they cannot be compared with ours. Source: ") +
                        kPaperSource + ".");
  return table;
}

Table toleranceTable(std::span<const RunResult> runs) {
  constexpr std::array<double, 6> kFactors = {0.1, 0.25, 0.5, 1.0, 2.0, 3.0};
  Table table{"tolerance",
              "Success, percent, against multiples of the requirement",
              groupColumns({}),
              {},
              {}};
  for (const double factor : kFactors)
    table.columns.push_back({fixedText(factor, 2) + " x", {}, 1});
  for (const RunGroup& group : runGroups(runs)) {
    table.rows.push_back({group.station, rangeText(group.far), group.method});
    for (const double factor : kFactors)
      table.rows.back().emplace_back(percentWithin(group.runs, factor));
  }
  return table;
}

Table timeTable(std::span<const RunResult> runs) {
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
