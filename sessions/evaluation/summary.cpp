// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

using GroupKey = std::pair<std::string, bool>;
using Members = std::vector<const RunResult*>;

std::map<GroupKey, Members> grouped(std::span<const RunResult> results) {
  std::map<GroupKey, Members> groups;
  for (const RunResult& result : results)
    groups[{result.station, result.hasTag(kFarTag)}].push_back(&result);
  return groups;
}

/// Statistics of one figure of the error over completed runs that have it.
Statistics statisticsOf(std::span<const RunResult* const> runs,
                        std::optional<double> (*figure)(const PoseError&)) {
  std::vector<double> values;
  for (const RunResult* run : runs)
    if (const auto value = run->completed && run->error ? figure(*run->error) : std::nullopt)
      values.push_back(*value);
  return statistics(values);
}

std::string percentText(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? fixedText(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1)
                   : "-";
}

std::string statisticsText(const Statistics& figures, int decimals) {
  if (figures.count == 0) return "-";
  return fixedText(figures.mean, decimals) + " / " + fixedText(figures.deviation, decimals) +
         " / " + fixedText(figures.maximum, decimals);
}

std::string rangeText(bool far) { return far ? "far" : "near"; }

std::vector<std::string> rowOf(const GroupSummary& group, const std::string& range) {
  const bool judged = group.judged > 0;
  const Statistics& projection_px = group.projection_px;
  return {group.station,
          range,
          std::to_string(group.runs),
          percentText(group.completed, group.runs),
          percentText(group.successful, group.judged),
          judged ? std::to_string(group.false_positives) : "-",
          judged ? std::to_string(group.gross_false_positives) : "-",
          statisticsText(group.normal_mm, 3),
          statisticsText(group.lateral_mm, 3),
          statisticsText(group.rotation_mrad, 3),
          projection_px.count > 0
              ? fixedText(projection_px.mean, 2) + " / " + fixedText(projection_px.maximum, 2)
              : "-",
          fixedText(group.mean_seconds, 2)};
}

}  // namespace

GroupSummary summaryOf(std::span<const RunResult* const> runs) {
  GroupSummary group;
  double seconds = 0.0;
  for (const RunResult* run : runs) {
    if (run->inputFailed()) {
      ++group.input_errors;
      continue;
    }
    ++group.runs;
    group.completed += run->completed ? 1 : 0;
    group.judged += run->success.has_value() ? 1 : 0;
    group.successful += run->success.value_or(false) ? 1 : 0;
    group.false_positives += run->false_positive ? 1 : 0;
    group.gross_false_positives += run->gross_false_positive ? 1 : 0;
    seconds += run->seconds.total();
  }
  if (group.runs > 0) group.mean_seconds = seconds / static_cast<double>(group.runs);
  using Value = std::optional<double>;
  group.normal_mm = statisticsOf(runs, [](const PoseError& e) -> Value { return e.normal_mm; });
  group.lateral_mm = statisticsOf(runs, [](const PoseError& e) -> Value { return e.lateral_mm; });
  group.rotation_mrad =
      statisticsOf(runs, [](const PoseError& e) -> Value { return e.rotation_mrad; });
  group.projection_px =
      statisticsOf(runs, [](const PoseError& e) -> Value { return e.projection_px; });
  return group;
}

std::vector<GroupSummary> summarize(std::span<const RunResult> results) {
  std::vector<GroupSummary> groups;
  for (const auto& [key, members] : grouped(results)) {
    groups.push_back(summaryOf(members));
    std::tie(groups.back().station, groups.back().far) = key;
  }
  return groups;
}

std::string summaryTable(std::span<const RunResult> results) {
  TextTable table({"station", "range", "runs", "completed %", "success %", "false pos.", "gross",
                   "normal mm", "lateral mm", "rotation mrad", "px mean / max", "s/run"});
  const std::vector<GroupSummary> groups = summarize(results);
  for (const GroupSummary& group : groups) table.add(rowOf(group, rangeText(group.far)));
  Members everybody;
  for (const RunResult& result : results) everybody.push_back(&result);
  GroupSummary all = summaryOf(everybody);
  all.station = "all";
  if (groups.size() > 1) table.add(rowOf(all, ""));
  std::string text =
      table.text() +
      "errors: mean / std / max over completed runs (max of |normal|), at the end effector, or at "
      "the camera\nof a case without one; px: projection error\n";
  if (all.input_errors > 0)
    text += std::to_string(all.input_errors) + " runs could not start: their input was refused\n";
  return text;
}

std::string toleranceTable(std::span<const RunResult> results) {
  constexpr std::array<double, 6> kFactors = {0.1, 0.25, 0.5, 1.0, 2.0, 3.0};
  std::vector<std::string> header = {"station", "range"};
  for (const double factor : kFactors) header.push_back(fixedText(factor, 2) + " x");
  TextTable table(header);
  bool any = false;
  for (const auto& [key, members] : grouped(results)) {
    std::vector<std::string> row = {key.first, rangeText(key.second)};
    for (const double factor : kFactors) {
      std::int64_t judged = 0;
      std::int64_t within = 0;
      for (const RunResult* result : members) {
        if (!result->success || !result->error || !result->requirement) continue;
        ++judged;
        if (result->completed && meetsRequirement(*result->error, *result->requirement, factor))
          ++within;
      }
      any = any || judged > 0;
      row.push_back(percentText(within, judged));
    }
    table.add(row);
  }
  return any ? "success % against multiples of the requirement\n" + table.text() : "";
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

std::string durationText(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0) return "?";
  if (seconds < 59.5) return fixedText(seconds, 0) + " s";
  const auto minutes = static_cast<long long>(std::llround(seconds / 60.0));
  if (minutes < 60) return std::to_string(minutes) + " min";
  char text[48];
  if (minutes < 24 * 60) {
    std::snprintf(text, sizeof text, "%lld h %02lld min", minutes / 60, minutes % 60);
    return text;
  }
  const long long hours = std::llround(seconds / 3600.0);
  std::snprintf(text, sizeof text, "%lld %s %lld h", hours / 24, hours < 48 ? "day" : "days",
                hours % 24);
  return text;
}

std::string batchProgressText(std::size_t done, std::size_t total, std::size_t completed,
                              double seconds_since_began) {
  std::string text = std::to_string(done) + " of " + std::to_string(total) + " runs, " +
                     std::to_string(completed) + " completed";
  if (done == 0 || !(seconds_since_began > 0.0)) return text;
  const double seconds_each = seconds_since_began / static_cast<double>(done);
  text += ", " + fixedText(3600.0 / seconds_each, 0) + " an hour";
  if (done < total)
    text += ", " + durationText(seconds_each * static_cast<double>(total - done)) + " left";
  return text;
}

}  // namespace boresight::sessions
