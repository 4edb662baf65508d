// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/batch_progress.h"

#include <cmath>
#include <cstdio>

#include "sessions/text/text_table.h"

namespace boresight::sessions {

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
