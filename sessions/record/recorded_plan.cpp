// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/recorded_plan.h"

#include <bit>
#include <map>
#include <sstream>
#include <type_traits>

namespace boresight::sessions {
namespace {

std::string valueOf(const RecordedOption& option) {
  std::ostringstream text;
  text << option.value();
  return text.str();
}

/// False when the option is of another kind or its value out of range.
template <class Field>
bool assign(const OptionInfo& info, const RecordedOption& recorded, Field& field) {
  if (recorded.kind != optionKindOf<Field>()) return false;
  const double value = recorded.value();
  if (!(value >= info.minimum && value <= info.maximum)) return false;
  if constexpr (std::is_floating_point_v<Field>) {
    field = std::bit_cast<double>(recorded.bits);
  } else {
    if constexpr (std::is_enum_v<Field>)
      if (recorded.bits >= info.choices.size()) return false;
    field = static_cast<Field>(static_cast<std::int64_t>(recorded.bits));
  }
  return true;
}

LocalizerOptions optionsOf(const RecordedOptions& recorded, std::vector<std::string>& remarks) {
  std::map<std::string, const RecordedOption*> left;
  for (const RecordedOption& option : recorded.options) left[option.name] = &option;
  LocalizerOptions options = defaultProfile();
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    const auto found = left.find(info.name);
    if (found == left.end()) {
      remarks.push_back("The record has no option " + std::string(info.name) +
                        ": it has its default here.");
      return;
    }
    if (!assign(info, *found->second, field))
      remarks.push_back("The option " + found->first + " was " + valueOf(*found->second) +
                        " on board, which this program does not take: it has its default here.");
    left.erase(found);
  });
  for (const auto& [name, option] : left)
    remarks.push_back("The option " + name + " (" + valueOf(*option) +
                      " on board) is none of this program: it is left out.");
  return options;
}

}  // namespace

RecordedPlan planOf(const OnboardRecord& record) {
  RecordedPlan made;
  made.plan.options = defaultProfile();
  for (const RecordedOptions& recorded : record.options) {
    std::vector<std::string> remarks;
    const LocalizerOptions options = optionsOf(recorded, remarks);
    if (recorded.first_iteration == 0 && !made.has_options) {
      made.plan.options = options;
      made.has_options = true;
      made.remarks = remarks;  // those of changes are the same
    } else {
      made.plan.changes.push_back({recorded.first_iteration, options});
    }
  }
  if (!made.has_options)
    made.remarks.push_back("The record has no options: all have their default here.");
  const std::string problem = planProblem(made.plan);
  if (!problem.empty()) {
    made.remarks.push_back("The options that were taken up on the way are left out: " + problem +
                           ".");
    made.plan.changes.clear();
  }
  return made;
}

}  // namespace boresight::sessions
