// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/check_making.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace boresight::sessions {
namespace {

std::string joined(bool passed, const std::string& found, const std::string& remedy) {
  return passed || remedy.empty() ? found : found + " " + remedy;
}

}  // namespace

Check measuredCheck(const CheckName& name, const std::string& unit, double figure, double limit,
                    LimitSide side, const std::string& found, const std::string& remedy) {
  const bool holds = side == LimitSide::kAtMost ? figure <= limit : figure >= limit;
  const bool passed = std::isfinite(figure) && holds;
  Check check = statedCheck(name, passed, found, remedy);
  if (std::isfinite(figure)) check.figure = figure;
  check.limit = limit;
  check.side = side;
  check.unit = unit;
  return check;
}

Check statedCheck(const CheckName& name, bool passed, const std::string& found,
                  const std::string& remedy) {
  Check check;
  check.id = name.id;
  check.title = name.title;
  check.state = passed ? CheckState::kPassed : CheckState::kFailed;
  check.sentence = joined(passed, found, remedy);
  return check;
}

Check notAskedCheck(const CheckName& name, const std::string& why) {
  Check check;
  check.id = name.id;
  check.title = name.title;
  check.sentence = why;
  return check;
}

std::string percentText(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %";
}

std::string sentenceNumber(double value) {
  const double size = std::abs(value);
  int decimals = 0;
  for (double unit = 100.0; size < unit && decimals < 4; unit /= 10.0) ++decimals;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", std::min(decimals, 4), value);
  return text;
}

}  // namespace boresight::sessions
