// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::sessions {

/// A case with this tag is far.
inline constexpr const char* kFarTag = "far";

/// One row of the closing summary: the runs of a station, near or far. Runs whose input could not
/// be read are counted apart and in nothing else.
struct GroupSummary {
  std::string station;
  bool far = false;
  std::int64_t runs = 0;
  std::int64_t input_errors = 0;
  std::int64_t completed = 0;
  std::int64_t judged = 0;  ///< runs with truth and requirement (or a wrong mesh)
  std::int64_t successful = 0;
  std::int64_t false_positives = 0;
  std::int64_t gross_false_positives = 0;
  Statistics normal_mm;  ///< of completed runs with truth, as are the next three
  Statistics lateral_mm;
  Statistics rotation_mrad;
  Statistics projection_px;
  double mean_seconds = 0.0;
};

/// Of these runs, whatever their stations; station and range stay empty.
GroupSummary summaryOf(std::span<const RunResult* const> runs);

/// By station name, near before far; groups without runs do not appear.
std::vector<GroupSummary> summarize(std::span<const RunResult> results);

/// The groups, and all runs together, as a table of fixed width, mean / std / max in the paper's
/// units.
std::string summaryTable(std::span<const RunResult> results);

/// Share of runs (percent) that completed within each of several multiples of the requirement.
std::string toleranceTable(std::span<const RunResult> results);

/// One line for each run that was judged and not successful, at most `limit` of them.
std::string failureList(std::span<const RunResult> results, std::size_t limit);

/// "12 s", "4 min", "2 h 05 min", "3 days 4 h": rounded as one reads a wait.
std::string durationText(double seconds);

/// How far a batch is: "12 of 40 runs, 11 completed, 720 an hour, 2 min left". Rate and time left
/// follow from what was done since `began`, and are left out before the first run.
std::string batchProgressText(std::size_t done, std::size_t total, std::size_t completed,
                              double seconds_since_began);

}  // namespace boresight::sessions
