// SPDX-License-Identifier: Apache-2.0
// The tables of the paper for our runs.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/tables/table.h"

namespace boresight::sessions {

/// A count of runs with its percent and the one-sided 95 % bounds of Clopper and Pearson. Runs from
/// several seeds of one image are not independent: the bounds are of images, of which one counts
/// for the lower bound when all of its runs count, for the upper bound when any does. Empty without
/// runs.
struct CountedShare {
  std::int64_t count = 0;
  std::int64_t runs = 0;
  std::int64_t images = 0;
  std::int64_t whole_images = 0;    ///< all of whose runs count
  std::int64_t touched_images = 0;  ///< any of whose runs counts

  std::optional<double> percent() const;
  std::optional<double> leastPercent() const;
  std::optional<double> mostPercent() const;
};

/// Columns of a share and their cells: percent and lower bound; percent and upper bound.
inline const std::vector<std::string> kLeast = {"measured", "at least"};
inline const std::vector<std::string> kMost = {"measured", "at most"};
std::vector<std::optional<double>> leastCell(const CountedShare& share);
std::vector<std::optional<double>> mostCell(const CountedShare& share);
inline constexpr const char* kBoundsNote =
    "At least, at most: one-sided 95 % bounds (Clopper-Pearson) over images; an image counts when "
    "all of its runs do (at most: any).";

/// Figures of one method on the near or the far cases of a station. Runs whose input was rejected
/// are not counted.
struct MethodFigures {
  std::string station;
  bool far = false;
  std::string method;      ///< "seed": the errors that the runs began with
  std::int64_t cases = 0;  ///< several seeds of `--reseed` may start from each
  std::int64_t runs = 0;
  CountedShare completed;
  CountedShare success;          ///< of runs with truth and requirement
  CountedShare false_positives;  ///< of the same
  std::int64_t gross_false_positives = 0;
  /// Runs that ended at the limit of iterations count as completed, with their last pose: the other
  /// interpretation of the paper's "converges to a pose at all" (Sec. V-A).
  std::int64_t at_limit = 0;
  CountedShare completed_with_limit;
  CountedShare success_with_limit;
  /// By kJudgedFigures (normal, lateral, rotation, projection): percent of completed runs within
  /// the requirement, of runs whose requirement names the figure.
  std::array<std::optional<double>, 4> within_percent;
  Statistics iterations;            ///< over completed runs
  std::array<Statistics, 4> error;  ///< over completed runs, by kErrorColumns
};

/// Normal mm, lateral mm, rotation mrad, projection px.
struct ErrorColumn {
  const char* name;
  int decimals;
  std::optional<double> (*of)(const PoseError&);
};
extern const std::array<ErrorColumn, 4> kErrorColumns;

/// One for each station, near before far, and method; a station's seeds come first (of all its
/// runs, each seed once).
std::vector<MethodFigures> methodFigures(std::span<const RunResult> runs);

/// Percent of judged runs that completed within `factor` times the requirement; empty when none was
/// judged.
std::optional<double> percentWithin(std::span<const RunResult* const> runs, double factor);

/// Seconds of wall time, over all runs of a method that were carried out.
struct MethodTimes {
  std::string method;
  std::int64_t runs = 0;
  StageSeconds mean;
  double median_total = 0.0;
  double maximum_total = 0.0;
};
std::vector<MethodTimes> methodTimes(std::span<const RunResult> runs);

/// Runs of one station, near or far, and method.
struct RunGroup {
  std::string station;
  bool far = false;
  std::string method;
  std::vector<const RunResult*> runs;
};

/// By station, near before far, and method. Runs whose input was rejected are left out.
std::vector<RunGroup> runGroups(std::span<const RunResult> runs);
MethodFigures figuresOf(std::span<const RunResult* const> runs);
/// Columns of a group's station, range and method, and further ones.
std::vector<TableColumn> groupColumns(const std::vector<TableColumn>& further);
/// "near", "far".
const char* rangeText(bool far);

/// "errors": mean / std / max per station and method; "success": completed, success, and within the
/// requirement axis by axis; "tolerance": success against multiples of the requirement; "times":
/// mean seconds per step. With the paper's rows if requested and known.
Table errorTable(std::span<const RunResult> runs, bool with_paper);
Table successTable(std::span<const RunResult> runs, bool with_paper);
Table toleranceTable(std::span<const RunResult> runs);
Table timeTable(std::span<const RunResult> runs);

/// The error table of the runs, with a row per method over all stations where there are several.
Table summaryTable(std::span<const RunResult> runs);

/// One line for each run that was judged and not successful, at most `limit` of them.
std::string failureList(std::span<const RunResult> results, std::size_t limit);

/// The median (the mean of the two middle values); empty without values.
std::optional<double> median(std::vector<double> values);

}  // namespace boresight::sessions
