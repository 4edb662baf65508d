// SPDX-License-Identifier: Apache-2.0
#include <cctype>

#include "sessions/review/run_difference.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

std::string errorText(const RunSide& side) {
  if (!side.error) return "-";
  return fixedText(side.error->normal_mm, 2) + " mm, " + fixedText(side.error->lateral_mm, 2) +
         " mm, " + fixedText(side.error->rotation_mrad, 2) + " mrad";
}

std::string endText(const RunSide& side) {
  return side.status + ", " + std::to_string(side.iterations) + " iterations";
}

std::string checkText(const RunSide& side) {
  return std::to_string(side.checks_passed) + " passed, " + std::to_string(side.checks_failed) +
         " failed";
}

std::string sentence(std::string clause) {
  if (!clause.empty())
    clause[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(clause[0])));
  return clause + ".";
}

}  // namespace

std::vector<DifferenceLine> differenceLines(const RunDifference& made) {
  std::vector<DifferenceLine> lines = {
      {"How it ended", endText(made.before), endText(made.after)},
      {"Inliers", std::to_string(made.before.inliers), std::to_string(made.after.inliers)},
      {"Checks", checkText(made.before), checkText(made.after)}};
  if (made.before.error || made.after.error)
    lines.push_back(
        {"Off the truth: along, across, turned", errorText(made.before), errorText(made.after)});
  for (const CheckChange& check : made.checks)
    lines.push_back({check.title, checkStateText(check.before), checkStateText(check.after)});
  for (const OptionChangeText& option : made.options)
    lines.push_back({option.name, option.before, option.after});
  return lines;
}

std::string changeText(const RunDifference& made) {
  std::string text = sentence(std::string(runChangeText(made.change)) + ": " + made.why);
  if (made.inputs_differ) text += " The runs were given other inputs.";
  if (made.comparison.first)
    text += " They differ first in the " + std::string(runPartText(made.comparison.first->part)) +
            ": " + made.comparison.first->text + ".";
  return text;
}

std::string differenceText(const RunDifference& made) {
  TextTable table({made.case_id, "before", "now"});
  for (const DifferenceLine& line : differenceLines(made))
    table.add({line.label, line.before, line.after});
  std::string apart;
  if (made.before.converged && made.after.converged)
    apart = "Final poses " + fixedText(made.comparison.translation_mm, 3) + " mm and " +
            fixedText(made.comparison.rotation_mrad, 3) + " mrad apart at the camera.\n";
  return table.text() + apart + plainLine(changeText(made));
}

}  // namespace boresight::sessions
