// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/check.h"

#include <algorithm>
#include <cmath>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

std::string numberText(double value, const std::string& unit) {
  const bool large = std::abs(value) >= 999.5 && std::abs(value) < 1e6;  // not as 9e+03
  const std::string text = large ? formatText("%.0f", value) : threeDigits(value);
  return unit.empty() ? text : text + " " + unit;
}

Check checkOf(const CheckName& name, CheckState state, const std::string& sentence) {
  Check check;
  check.id = name.id;
  check.title = name.title;
  check.state = state;
  check.sentence = sentence;
  return check;
}

}  // namespace

const char* checkStateText(CheckState state) {
  constexpr const char* kTexts[] = {"passed", "failed", "not applicable"};
  return kTexts[static_cast<std::size_t>(state)];
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

int countOf(std::span<const Check> checks, CheckState state) {
  return static_cast<int>(std::ranges::count(checks, state, &Check::state));
}

bool allPassed(std::span<const Check> checks) {
  return countOf(checks, CheckState::kPassed) > 0 && countOf(checks, CheckState::kFailed) == 0;
}

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
  return checkOf(name, passed ? CheckState::kPassed : CheckState::kFailed,
                 passed || remedy.empty() ? found : found + " " + remedy);
}

Check notAskedCheck(const CheckName& name, const std::string& why) {
  return checkOf(name, CheckState::kNotApplicable, why);
}

void addNotAsked(const std::vector<CheckName>& names, const std::string& why,
                 std::vector<Check>& checks) {
  for (const CheckName& name : names) checks.push_back(notAskedCheck(name, why));
}

std::string sentenceNumber(double value) {
  const double size = std::abs(value);
  int decimals = 0;
  for (double unit = 100.0; size < unit && decimals < 4; unit /= 10.0) ++decimals;
  return formatText("%.*f", decimals, value);
}

std::string checkCountsText(std::span<const Check> checks) {
  return std::to_string(countOf(checks, CheckState::kPassed)) + " passed, " +
         std::to_string(countOf(checks, CheckState::kFailed)) + " failed, " +
         std::to_string(countOf(checks, CheckState::kNotApplicable)) + " not applicable";
}

std::string checksText(std::span<const Check> checks, bool all_sentences) {
  constexpr const char* kPrefixes[] = {"pass  ", "FAIL  ", "  -   "};
  std::size_t width = 0;
  for (const Check& check : checks) width = std::max(width, check.title.size());
  std::string text;
  for (const Check& check : checks) {
    text += kPrefixes[static_cast<std::size_t>(check.state)] + check.title;
    if (const std::string figure = figureText(check); !figure.empty())
      text += std::string(width - check.title.size() + 2, ' ') + figure;
    text += "\n";
    if (all_sentences || check.state != CheckState::kPassed)
      text += plainLine("      " + check.sentence);
  }
  return text + checkCountsText(checks) + "\n";
}

}  // namespace boresight::sessions
