// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/options.h"

namespace boresight::sessions {

/// Value of one option outside of its struct; an enum's value is the name of its choice.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

/// Options by name, in the order in which they were given or are declared.
using OptionList = std::vector<std::pair<std::string, OptionValue>>;

enum class OptionKind { kBoolean, kInteger, kReal, kChoice };

/// Description of one option of a struct: for panels, help texts, files.
struct OptionDescription {
  std::string name;
  std::string unit;
  OptionKind kind = OptionKind::kReal;
  double minimum = 0.0;
  double maximum = 0.0;
  std::string help;
  std::vector<std::string> choices;
  OptionValue value;
};

/// An option that does not exist or cannot have the value: "NAME: REASON".
class OptionError : public std::runtime_error {
 public:
  OptionError(const std::string& name, const std::string& reason);
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The value in the option's own kind (5 for 5.0 of an integer). OptionError naming the range and
/// unit when it is of another kind, out of range, not finite, or not among the choices.
OptionValue checkedValue(const OptionDescription& option, const OptionValue& value);

/// A value given as text: "true", "12", "0.5", "histogram". OptionError.
OptionValue parsedValue(const OptionDescription& option, std::string_view text);

/// For display: "1.5 px", "true", "histogram".
std::string valueText(const OptionDescription& option, const OptionValue& value);

template <class Field>
OptionDescription describeOption(const OptionInfo& info, const Field& field) {
  OptionDescription option{
      info.name, info.unit, OptionKind::kReal, info.minimum, info.maximum, info.help, {}, {}};
  for (const char* choice : info.choices) option.choices.emplace_back(choice);
  if constexpr (std::is_same_v<Field, bool>) {
    option.kind = OptionKind::kBoolean;
    option.value = field;
  } else if constexpr (std::is_enum_v<Field>) {
    option.kind = OptionKind::kChoice;
    const auto index = static_cast<std::size_t>(field);
    option.value = index < option.choices.size() ? option.choices[index] : std::string("?");
  } else if constexpr (std::is_integral_v<Field>) {
    option.kind = OptionKind::kInteger;
    option.minimum = std::max(info.minimum, static_cast<double>(std::numeric_limits<Field>::min()));
    option.maximum = std::min(info.maximum, static_cast<double>(std::numeric_limits<Field>::max()));
    option.value = static_cast<std::int64_t>(field);
  } else {
    static_assert(std::is_same_v<Field, double>);
    option.value = field;
  }
  return option;
}

/// Sets a field to a value that `checkedValue` returned for it.
template <class Field>
void assignOption(const OptionDescription& option, const OptionValue& checked, Field& field) {
  if constexpr (std::is_same_v<Field, bool>) {
    field = std::get<bool>(checked);
  } else if constexpr (std::is_enum_v<Field>) {
    const auto found =
        std::find(option.choices.begin(), option.choices.end(), std::get<std::string>(checked));
    field = static_cast<Field>(found - option.choices.begin());
  } else if constexpr (std::is_integral_v<Field>) {
    field = static_cast<Field>(std::get<std::int64_t>(checked));
  } else {
    field = std::get<double>(checked);
  }
}

/// All options of a struct with their values, in the order of declaration.
template <class Options>
std::vector<OptionDescription> listOptions(const Options& options) {
  std::vector<OptionDescription> all;
  Options::visitFields(options, [&all](const OptionInfo& info, const auto& field) {
    all.push_back(describeOption(info, field));
  });
  return all;
}

/// Applies `convert` (description -> checked value) to the option of this name; OptionError when
/// there is none.
template <class Options, class Convert>
void withOption(Options& options, const std::string& name, Convert&& convert) {
  bool found = false;
  Options::visitFields(options, [&](const OptionInfo& info, auto& field) {
    if (name != info.name) return;
    found = true;
    const OptionDescription option = describeOption(info, field);
    assignOption(option, convert(option), field);
  });
  if (!found) throw OptionError(name, "unknown option");
}

/// Sets one option; on OptionError it is unchanged.
template <class Options>
void applyOption(Options& options, const std::string& name, const OptionValue& value) {
  withOption(options, name,
             [&value](const OptionDescription& option) { return checkedValue(option, value); });
}

/// The same from text, as on a command line.
template <class Options>
void applyOptionText(Options& options, const std::string& name, std::string_view text) {
  withOption(options, name,
             [text](const OptionDescription& option) { return parsedValue(option, text); });
}

/// The options that differ from `defaults`, in the order of declaration.
template <class Options>
OptionList changedOptions(const Options& options, const Options& defaults) {
  const std::vector<OptionDescription> after = listOptions(options);
  const std::vector<OptionDescription> before = listOptions(defaults);
  OptionList changed;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i].value != before[i].value) changed.emplace_back(after[i].name, after[i].value);
  return changed;
}

}  // namespace boresight::sessions
