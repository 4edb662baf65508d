// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/checks_text.h"

#include <algorithm>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

const char* mark(CheckState state) {
  switch (state) {
    case CheckState::kPassed:
      return "pass  ";
    case CheckState::kFailed:
      return "FAIL  ";
    case CheckState::kNotApplicable:
      break;
  }
  return "  -   ";
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

long countOf(std::span<const Check> checks, CheckState state) {
  return std::count_if(checks.begin(), checks.end(),
                       [state](const Check& check) { return check.state == state; });
}

}  // namespace

std::string checkCountsText(std::span<const Check> checks) {
  return std::to_string(countOf(checks, CheckState::kPassed)) + " passed, " +
         std::to_string(countOf(checks, CheckState::kFailed)) + " failed, " +
         std::to_string(countOf(checks, CheckState::kNotApplicable)) + " not applicable";
}

std::string checksText(std::span<const Check> checks, bool all_sentences) {
  std::size_t width = 0;
  for (const Check& check : checks) width = std::max(width, check.title.size());
  std::string text;
  for (const Check& check : checks) {
    const std::string figure = figureText(check);
    const bool plain = figure.empty();
    text += mark(check.state);
    text += plain ? check.title : padded(check.title, width) + "  " + figure;
    text += "\n";
    if (all_sentences || check.state != CheckState::kPassed)
      text += plainLine("      " + check.sentence);
  }
  return text + checkCountsText(checks) + "\n";
}

}  // namespace boresight::sessions
