// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/method_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "sessions/tables/results_set.h"

namespace boresight::sessions {
namespace {

// What Pham 2025 (IEEE RA-L, DOI 10.1109/LRA.2025.3614045) reports, to be shown beside our own.
constexpr const char* kPaperSource = "Pham et al., IEEE RA-L 2025, 10.1109/LRA.2025.3614045";
/// To be said wherever its success stands beside ours.
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

/// Real images.
struct PaperSuccess {
  const char* set;
  int runs;
  const char* method;
  double completed_percent;
  double success_percent;
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
    {"testbed OS", 20, "orb", 0, 0},
    {"testbed OS", 20, "ssd", 100, 45},
    {"testbed OS", 20, "ncc", 100, 45},
    {"testbed OS", 20, "loftr-r", 70, 5},
    {"testbed OS", 20, "loftr-s", 10, 0},
    {"testbed OS", 20, "whs", 100, 100},
    {"testbed BC", 20, "orb", 0, 0},
    {"testbed BC", 20, "ssd", 40, 0},
    {"testbed BC", 20, "ncc", 65, 0},
    {"testbed BC", 20, "loftr-r", 100, 95},
    {"testbed BC", 20, "loftr-s", 100, 95},
    {"testbed BC", 20, "whs", 100, 100},
    {"Mars BC near 0.49 m", 3, "orb", 0, 0},
    {"Mars BC near 0.49 m", 3, "ssd", 0, 0},
    {"Mars BC near 0.49 m", 3, "ncc", 33.3, 0},
    {"Mars BC near 0.49 m", 3, "loftr-r", 100, 100},
    {"Mars BC near 0.49 m", 3, "loftr-s", 66.7, 0},
    {"Mars BC near 0.49 m", 3, "whs", 100, 100},
    {"Mars BC far 1.23 m", 3, "orb", 0, 0},
    {"Mars BC far 1.23 m", 3, "ssd", 0, 0},
    {"Mars BC far 1.23 m", 3, "ncc", 0, 0},
    {"Mars BC far 1.23 m", 3, "loftr-r", 100, 0},
    {"Mars BC far 1.23 m", 3, "loftr-s", 33.3, 0},
    {"Mars BC far 1.23 m", 3, "whs", 100, 0},
};

constexpr const char* kSeed = "seed";

using Members = std::vector<const RunResult*>;

std::optional<double> percent(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Percent of completed runs within what the requirement says of one figure, over those where it
/// says something of it.
std::optional<double> percentWithin(const Members& members, const JudgedFigure& figure) {
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

MethodFigures figuresOf(const Members& members) {
  MethodFigures figures{summaryOf(members), {}, {}, {}, {}};
  figures.completed_percent = percent(figures.completed, figures.runs);
  figures.success_percent = percent(figures.successful, figures.judged);
  for (std::size_t i = 0; i < kJudgedFigures.size(); ++i)
    figures.within_percent[i] = percentWithin(members, kJudgedFigures[i]);
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
    seed.false_positive = false;  // nobody claims that a seed is right
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

std::string paperName(const std::string& method) { return method + " (paper)"; }

std::vector<std::vector<TableCell>> paperErrorRows(const std::string& station) {
  std::vector<std::vector<TableCell>> rows;
  for (const PaperErrors& row : kErrors) {
    if (row.station != station) continue;
    const bool any = row.completed_percent > 0.0;
    rows.push_back({row.station, "near", paperName(row.method), "2000", row.completed_percent,
                    row.success_percent, std::nullopt, statisticsCell(row.normal_mm, any),
                    statisticsCell(row.lateral_mm, any), statisticsCell(row.rotation_mrad, any)});
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

std::vector<MethodFigures> methodFigures(std::span<const RunResult> runs) {
  const std::vector<RunResult> seeds = seedsOf(runs);
  const auto before = [](const auto& a, const auto& b) {
    if (std::tie(std::get<0>(a), std::get<1>(a)) != std::tie(std::get<0>(b), std::get<1>(b)))
      return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
    return methodBefore(std::get<2>(a), std::get<2>(b));
  };
  std::map<std::tuple<std::string, bool, std::string>, Members, decltype(before)> groups(before);
  for (const std::span<const RunResult> all : {std::span<const RunResult>(seeds), runs})
    for (const RunResult& run : all)
      if (!run.inputFailed())
        groups[{run.station, run.hasTag(kFarTag), run.method}].push_back(&run);
  std::vector<MethodFigures> rows;
  for (const auto& [key, members] : groups) {
    rows.push_back(figuresOf(members));
    std::tie(rows.back().station, rows.back().far, rows.back().method) = key;
  }
  return rows;
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
    for (double StageSeconds::*part :
         {&StageSeconds::initialization, &StageSeconds::rendering, &StageSeconds::matching,
          &StageSeconds::pose, &StageSeconds::refinement})
      times.mean.*part /= static_cast<double>(members.size());
    times.median_total = median(totals).value_or(0.0);
    times.maximum_total = *std::max_element(totals.begin(), totals.end());
    rows.push_back(std::move(times));
  }
  return rows;
}

Table errorTable(std::span<const RunResult> runs, bool with_paper) {
  const std::vector<std::string> parts = {"mean", "std", "max"};
  Table table{"errors",
              "Errors per station and method, over completed runs",
              {{"station"},
               {"range"},
               {"method"},
               {"runs"},
               {"completed %", {}, 1},
               {"success %", {}, 1},
               {"false positives"},
               {"normal mm", parts, 3},
               {"lateral mm", parts, 3},
               {"rotation mrad", parts, 3}},
              {},
              {"Errors are those of the end effector, or of the camera where a case has none.",
               "The maximum of the normal error is that of its absolute value."}};
  std::string station;
  for (const MethodFigures& row : methodFigures(runs)) {
    if (with_paper && row.station != station)
      for (auto& paper_row : paperErrorRows(row.station))
        table.rows.push_back(std::move(paper_row));
    station = row.station;
    table.rows.push_back(
        {row.station, rangeText(row.far), row.method, row.runs, row.completed_percent,
         row.success_percent,
         row.method == kSeed ? TableCell(std::nullopt) : TableCell(row.false_positives),
         statisticsCell(row.normal_mm), statisticsCell(row.lateral_mm),
         statisticsCell(row.rotation_mrad)});
  }
  if (with_paper) {
    table.notes.emplace_back(kPaperCaution);
    table.notes.push_back(std::string("Source: ") + kPaperSource + ".");
  }
  return table;
}

Table successTable(std::span<const RunResult> runs, bool with_paper) {
  Table table{"success",
              "Completed and successful runs, percent",
              {{"station"},
               {"range"},
               {"method"},
               {"runs"},
               {"completed %", {}, 1},
               {"success %", {}, 1},
               {"within normal %", {}, 1},
               {"within lateral %", {}, 1},
               {"within rotation %", {}, 1},
               {"within projection %", {}, 1}},
              {},
              {"Within: completed and within what the requirement says of that error alone."}};
  for (const MethodFigures& row : methodFigures(runs)) {
    if (row.method == kSeed) continue;
    table.rows.push_back({row.station, rangeText(row.far), row.method, row.runs,
                          row.completed_percent, row.success_percent, row.within_percent[0],
                          row.within_percent[1], row.within_percent[2], row.within_percent[3]});
  }
  if (!with_paper) return table;
  for (const PaperSuccess& row : kSuccess)
    table.rows.push_back({row.set, "", paperName(row.method), std::int64_t{row.runs},
                          row.completed_percent, row.success_percent, std::nullopt, std::nullopt,
                          std::nullopt, std::nullopt});
  table.notes.push_back(std::string("Rows marked (paper) are of other images, cameras and "
                                    "requirements: they cannot be compared with ours. Source: ") +
                        kPaperSource + ".");
  return table;
}

Table timeTable(std::span<const RunResult> runs, bool with_paper) {
  Table table{"times",
              "Time per run and step, seconds",
              {{"method"},
               {"runs"},
               {"initialization", {}, 3},
               {"rendering", {}, 3},
               {"matching", {}, 3},
               {"pose", {}, 3},
               {"refinement", {}, 3},
               {"total", {}, 3},
               {"median", {}, 3},
               {"maximum", {}, 3}},
              {},
              {"Means of wall time; median and maximum are of a run's total."}};
  for (const MethodTimes& row : methodTimes(runs))
    table.rows.push_back({row.method, row.runs, row.mean.initialization, row.mean.rendering,
                          row.mean.matching, row.mean.pose, row.mean.refinement, row.mean.total(),
                          row.median_total, row.maximum_total});
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

}  // namespace boresight::sessions
