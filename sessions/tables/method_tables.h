// SPDX-License-Identifier: Apache-2.0
// The tables of the paper, of our runs.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/summary.h"
#include "sessions/tables/table.h"

namespace boresight::sessions {

/// What a method made of a station's cases, near or far. Runs whose input was refused count in
/// nothing.
struct MethodFigures : GroupSummary {
  std::string method;  ///< "seed": the errors that the runs began with
  std::optional<double> completed_percent;
  std::optional<double> success_percent;  ///< of runs with truth and requirement
  /// Percent of the runs whose requirement names it that completed within it, by kJudgedFigures:
  /// normal, lateral, rotation, projection.
  std::array<std::optional<double>, 4> within_percent;
};

/// One for each station, near before far, and method; a station's seeds come first (of all its
/// runs, each seed once).
std::vector<MethodFigures> methodFigures(std::span<const RunResult> runs);

/// Seconds of wall time, over all runs of a method that were carried out.
struct MethodTimes {
  std::string method;
  std::int64_t runs = 0;
  StageSeconds mean;
  double median_total = 0.0;
  double maximum_total = 0.0;
};
std::vector<MethodTimes> methodTimes(std::span<const RunResult> runs);

/// "errors": mean / std / max per station and method; "success": completed, success, and within the
/// requirement axis by axis; "times": mean seconds per step. With the paper's rows where asked for.
Table errorTable(std::span<const RunResult> runs, bool with_paper);
Table successTable(std::span<const RunResult> runs, bool with_paper);
Table timeTable(std::span<const RunResult> runs, bool with_paper);

/// The middle of the values (the mean of two); nothing of none.
std::optional<double> median(std::vector<double> values);

}  // namespace boresight::sessions
