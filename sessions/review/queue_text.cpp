// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "sessions/review/queue.h"
#include "sessions/text/csv_field.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr double kPercent = 100.0;

std::string marginText(const QueueRow& row) {
  return row.margin ? fixedText(kPercent * *row.margin, 0) + " %" : "-";
}

/// For programs: all digits that a double has, or nothing.
std::string field(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", *value);
  return text;
}

std::optional<double> part(const QueueRow& row, double SeedDistance::*member) {
  if (!row.from_seed) return {};
  return (*row.from_seed).*member;
}

}  // namespace

std::string queueText(const std::vector<QueueRow>& rows) {
  TextTable table({"case", "state", "failed", "passed", "margin", "mm", "mrad", "of seed's",
                   "inliers", "iteration"});
  for (const QueueRow& row : rows) {
    const SeedDistance from = row.from_seed.value_or(SeedDistance{NAN, NAN, NAN});
    const std::string share = row.from_seed ? fixedText(kPercent * from.share, 0) + " %" : "-";
    table.add({row.case_id, caseStandingText(row.standing), std::to_string(row.failed),
               std::to_string(row.passed), marginText(row), fixedText(from.translation_mm, 2),
               fixedText(from.rotation_mrad, 2), share, std::to_string(row.inliers),
               row.opens_at < 0
                   ? "-"
                   : std::to_string(row.opens_at + 1) + "/" + std::to_string(row.iterations)});
  }
  std::string text = table.text() + "\n";
  for (const QueueRow& row : rows) text += plainLine(row.case_id + ": " + troubleText(row));
  return text;
}

std::string queueCsv(const std::vector<QueueRow>& rows) {
  std::string text =
      "case,state,checks_failed,checks_passed,margin,margin_of,from_seed_mm,from_seed_mrad,"
      "from_seed_share,inliers,iterations,look_at_iteration,run,trouble\r\n";
  for (const QueueRow& row : rows) {
    const std::string fields[] = {row.case_id,
                                  caseStandingText(row.standing),
                                  std::to_string(row.failed),
                                  std::to_string(row.passed),
                                  field(row.margin),
                                  row.margin_of,
                                  field(part(row, &SeedDistance::translation_mm)),
                                  field(part(row, &SeedDistance::rotation_mrad)),
                                  field(part(row, &SeedDistance::share)),
                                  std::to_string(row.inliers),
                                  std::to_string(row.iterations),
                                  row.opens_at < 0 ? "" : std::to_string(row.opens_at + 1),
                                  row.run_digest,
                                  troubleText(row)};
    for (const std::string& each : fields) text += (&each == fields ? "" : ",") + csvField(each);
    text += "\r\n";
  }
  return text;
}

}  // namespace boresight::sessions
