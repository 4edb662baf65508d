// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValues = 4096;
constexpr std::size_t kMostText = 2000;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// GDAL writes the line ends inside a text as the characters \r and \n.
std::string withoutLineEnds(std::string text) {
  for (const char* end : {"\\r", "\\n"})
    for (auto at = text.find(end); at != std::string::npos; at = text.find(end, at))
      text.replace(at, 2, " ");
  return text;
}

/// "3.5 <rad>" in two.
std::pair<std::string_view, std::string_view> numberAndUnit(std::string_view text) {
  text = trimmed(text);
  const auto open = text.find('<');
  if (open == std::string_view::npos || !text.ends_with('>')) return {text, {}};
  return {trimmed(text.substr(0, open)), trimmed(text.substr(open + 1, text.size() - open - 2))};
}

/// {"value", "unit"} gives its value.
const json* unwrapped(const json* value) {
  if (value == nullptr || !value->is_object()) return value;
  const auto inner = value->find("value");
  return inner == value->end() ? value : &*inner;
}

std::optional<double> numberOf(std::string_view text) {
  std::string plain(numberAndUnit(text).first);
  if (plain.starts_with('+')) plain.erase(0, 1);
  for (char& c : plain)
    if (c == 'd' || c == 'D') c = 'E';
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool isAbsent(const std::string& text) {
  const std::string word = upperCase(text);
  for (const char* absent : {"", "N/A", "NULL", "UNK", "UNKNOWN"})
    if (word == absent) return true;
  return false;
}

}  // namespace

std::string upperCase(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  });
  return upper;
}

const json* labelMember(const json* object, std::string_view key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() || found->is_null() ? nullptr : &*found;
}

const json* labelMember(const json* object, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (const json* found = labelMember(object, key)) return found;
  return nullptr;
}

const json* labelPath(const json* object, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    // Of repeated elements the first.
    if (object != nullptr && object->is_array())
      object = object->empty() ? nullptr : &object->front();
    object = labelMember(object, key);
  }
  return object;
}

std::optional<std::string> labelText(const json* value) {
  value = unwrapped(value);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) {
    std::string text = withoutLineEnds(value->get<std::string>().substr(0, kMostText));
    if (text.size() >= 2 && text.front() == '\'' && text.back() == '\'')
      text = text.substr(1, text.size() - 2);
    text = std::string(trimmed(oneLine(text)));
    if (isAbsent(text)) return std::nullopt;
    return text;
  }
  if (value->is_number_integer()) return std::to_string(value->get<std::int64_t>());
  if (value->is_number()) return numberText(value->get<double>());
  if (value->is_boolean()) return value->get<bool>() ? "true" : "false";
  return std::nullopt;
}

std::vector<std::string> labelTexts(const json* value) {
  value = unwrapped(value);
  std::vector<std::string> texts;
  if (value == nullptr) return texts;
  if (!value->is_array()) return {labelText(value).value_or("")};
  for (const json& one : *value) {
    if (texts.size() == kMostValues) break;
    texts.push_back(labelText(&one).value_or(""));
  }
  return texts;
}

std::optional<double> labelNumber(const json* value) {
  value = unwrapped(value);
  if (value == nullptr) return std::nullopt;
  if (value->is_number()) {
    const double number = value->get<double>();
    if (!std::isfinite(number)) return std::nullopt;
    return number;
  }
  if (value->is_string()) return numberOf(value->get_ref<const std::string&>());
  return std::nullopt;
}

std::vector<double> labelNumbers(const json* value) {
  value = unwrapped(value);
  std::vector<double> numbers;
  if (value == nullptr) return numbers;
  if (!value->is_array()) {
    if (const auto number = labelNumber(value)) numbers.push_back(*number);
    return numbers;
  }
  if (value->size() > kMostValues) return numbers;
  for (const json& one : *value) {
    const auto number = labelNumber(&one);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<std::int64_t> labelInteger(const json* value) {
  const auto number = labelNumber(value);
  if (!number || *number != std::floor(*number) || std::abs(*number) > 9e15) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

std::optional<Eigen::Vector3d> labelVector(const json* value) {
  const std::vector<double> numbers = labelNumbers(value);
  if (numbers.size() != 3) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

std::string labelUnit(const json* value) {
  if (value == nullptr) return "";
  if (value->is_array()) {
    // All of a list, each once: one that mixes units has none of those that are known.
    std::vector<std::string> units;
    for (const json& one : *value)
      if (const std::string unit = labelUnit(&one);
          !unit.empty() && std::find(units.begin(), units.end(), unit) == units.end())
        units.push_back(unit);
    return joined(units);
  }
  if (value->is_object()) {
    const json* unit = labelMember(value, "unit");
    return unit != nullptr && unit->is_string()
               ? upperCase(trimmed(unit->get_ref<const std::string&>()))
               : "";
  }
  if (value->is_string())
    return upperCase(numberAndUnit(value->get_ref<const std::string&>()).second);
  return "";
}

std::string fixedNumber(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), std::abs(value) < 1e12 ? "%.*f" : "%.*e", decimals, value);
  return buffer;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all;
}

}  // namespace boresight::sessions
