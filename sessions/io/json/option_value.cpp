// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/option_value.h"

#include <cmath>
#include <optional>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string rangeText(const OptionDescription& option) {
  return numberText(option.minimum) + " .. " + withUnit(numberText(option.maximum), option.unit);
}

std::string plainText(const OptionValue& value) {
  if (const bool* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* real = std::get_if<double>(&value)) return numberText(*real);
  return "'" + std::get<std::string>(value) + "'";
}

[[noreturn]] void wrongKind(const OptionDescription& option, const OptionValue& value) {
  const std::string wanted[] = {"true or false", "an integer in " + rangeText(option),
                                "a number in " + rangeText(option),
                                "one of " + joined(option.choices)};  // by OptionKind
  throw OptionError(option.name,
                    plainText(value) + " is not " + wanted[static_cast<std::size_t>(option.kind)]);
}

std::optional<double> asReal(const OptionValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const double* real = std::get_if<double>(&value)) return *real;
  return std::nullopt;
}

void requireInRange(const OptionDescription& option, double number) {
  if (number >= option.minimum && number <= option.maximum) return;
  throw OptionError(option.name,
                    withUnit(numberText(number), option.unit) + " is outside " + rangeText(option));
}

OptionValue checkedInteger(const OptionDescription& option, const OptionValue& value) {
  const std::optional<double> number = asReal(value);
  if (!number) wrongKind(option, value);
  requireInRange(option, *number);
  if (std::holds_alternative<std::int64_t>(value)) return value;
  // Above 2^53 a double stands for several integers.
  if (std::floor(*number) != *number || std::abs(*number) > 9007199254740992.0)
    wrongKind(option, value);
  return static_cast<std::int64_t>(*number);
}

}  // namespace

OptionError::OptionError(const std::string& name, const std::string& reason)
    : std::runtime_error(oneLine(name + ": " + reason)), reason_(reason) {}

OptionValue checkedValue(const OptionDescription& option, const OptionValue& value) {
  switch (option.kind) {
    case OptionKind::kBoolean:
      if (!std::holds_alternative<bool>(value)) wrongKind(option, value);
      return value;
    case OptionKind::kInteger:
      return checkedInteger(option, value);
    case OptionKind::kReal: {
      const std::optional<double> number = asReal(value);
      if (!number) wrongKind(option, value);
      requireInRange(option, *number);
      return *number;
    }
    case OptionKind::kChoice: {
      const auto* name = std::get_if<std::string>(&value);
      if (name == nullptr ||
          std::find(option.choices.begin(), option.choices.end(), *name) == option.choices.end())
        wrongKind(option, value);
      return value;
    }
  }
  return value;
}

OptionValue parsedValue(const OptionDescription& option, std::string_view text) {
  const std::string whole(text);
  if (option.kind == OptionKind::kChoice) return checkedValue(option, whole);
  if (option.kind == OptionKind::kBoolean) {
    if (text == "true") return true;
    if (text == "false") return false;
    wrongKind(option, whole);
  }
  if (const auto integer = wholeIn<std::int64_t>(text)) return checkedValue(option, *integer);
  const auto real = realIn(text);
  if (!real) wrongKind(option, whole);
  return checkedValue(option, *real);
}

std::string valueText(const OptionDescription& option, const OptionValue& value) {
  if (const auto* name = std::get_if<std::string>(&value)) return *name;
  return withUnit(plainText(value), option.unit);
}

}  // namespace boresight::sessions
