// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/summary.h"
#include "sessions/tables/results_set.h"

namespace boresight::peers {
namespace {

using sessions::PoseError;
using sessions::RunResult;

std::string groupOf(const RunResult& run, bool each_station) {
  if (run.hasTag("real") && !each_station) return "photographs";
  return run.station + (run.hasTag(sessions::kFarTag) ? ", far" : "") +
         (run.hasTag("hard") ? ", hard" : "");
}

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Large errors need no decimals.
std::string numberText(double value) {
  const double size = std::abs(value);
  return text(size >= 100.0  ? "%.0f"
              : size >= 10.0 ? "%.1f"
              : size >= 1.0  ? "%.2f"
                             : "%.3f",
              value);
}

std::string errorsText(const std::vector<const RunResult*>& runs,
                       std::optional<double> (*of)(const PoseError&)) {
  std::vector<double> values;
  for (const RunResult* run : runs)
    if (run->error)
      if (const auto value = of(*run->error)) values.push_back(*value);
  if (values.empty()) return "-";
  double mean = 0.0;
  double largest = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double square = 0.0;
  for (const double value : values) {
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
    largest = std::max(largest, std::abs(value));
  }
  return numberText(mean) + " / " + numberText(std::sqrt(square)) + " / " + numberText(largest);
}

std::optional<double> normal(const PoseError& error) { return error.normal_mm; }
std::optional<double> lateral(const PoseError& error) { return error.lateral_mm; }
std::optional<double> rotation(const PoseError& error) { return error.rotation_mrad; }
std::optional<double> projection(const PoseError& error) { return error.projection_px; }

std::string secondsText(const std::vector<const RunResult*>& runs) {
  std::vector<double> seconds;
  for (const RunResult* run : runs)
    if (run->status != "killed") seconds.push_back(run->seconds.total());
  if (seconds.empty()) return "-";
  std::sort(seconds.begin(), seconds.end());
  return text("%.2f", seconds[seconds.size() / 2]) + " / " + text("%.2f", seconds.back());
}

std::string row(const std::string& group, const std::string& method,
                const std::vector<const RunResult*>& runs) {
  std::vector<const RunResult*> completed;
  std::vector<const RunResult*> successful;
  int false_positives = 0;
  for (const RunResult* run : runs) {
    if (run->completed) completed.push_back(run);
    if (run->success.value_or(false)) successful.push_back(run);
    false_positives += run->false_positive ? 1 : 0;
  }
  std::string line = "| " + group + " | " + method + " | " + std::to_string(runs.size()) + " | " +
                     std::to_string(completed.size()) + " | " + std::to_string(successful.size()) +
                     " | " + std::to_string(false_positives) + " | ";
  for (const auto of : {normal, lateral, rotation, projection})
    line += errorsText(successful, of) + " | ";
  return line + errorsText(completed, projection) + " | " + secondsText(runs) + " |\n";
}

}  // namespace

std::string peerTable(std::span<const RunResult> runs, bool each_station) {
  const auto before = [](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    return sessions::methodBefore(a.second, b.second);
  };
  std::map<std::pair<std::string, std::string>, std::vector<const RunResult*>, decltype(before)>
      groups(before);
  for (const RunResult& run : runs)
    if (!run.inputFailed()) groups[{groupOf(run, each_station), run.method}].push_back(&run);
  std::string table =
      "| cases | method | runs | completed | successful | false positives | normal mm | lateral mm "
      "| rotation mrad | projection px | projection px of all completed | seconds, median / max |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [key, members] : groups) table += row(key.first, key.second, members);
  return table;
}

}  // namespace boresight::peers
