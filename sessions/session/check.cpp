// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace boresight::sessions {
namespace {

std::string numberText(double value, const std::string& unit) {
  char text[40];
  const bool large = std::abs(value) >= 1000.0 && std::abs(value) < 1e6;  // not as 9e+03
  std::snprintf(text, sizeof text, large ? "%.0f" : "%.3g", value);
  return unit.empty() ? std::string(text) : text + (" " + unit);
}

bool hasState(std::span<const Check> checks, CheckState state) {
  return std::any_of(checks.begin(), checks.end(),
                     [state](const Check& check) { return check.state == state; });
}

}  // namespace

const char* checkStateText(CheckState state) {
  switch (state) {
    case CheckState::kPassed:
      return "passed";
    case CheckState::kFailed:
      return "failed";
    case CheckState::kNotApplicable:
      break;
  }
  return "not applicable";
}

std::string foundText(const Check& check) {
  return check.figure ? numberText(*check.figure, check.unit) : "";
}

std::string limitText(const Check& check) {
  if (!check.limit) return "";
  const char* side = check.side == LimitSide::kAtMost ? "at most " : "at least ";
  return side + numberText(*check.limit, check.unit);
}

std::string figureText(const Check& check) {
  if (!check.figure || !check.limit) return foundText(check);
  return foundText(check) + " (" + limitText(check) + ")";
}

bool allPassed(std::span<const Check> checks) {
  return hasState(checks, CheckState::kPassed) && !hasState(checks, CheckState::kFailed);
}

}  // namespace boresight::sessions
