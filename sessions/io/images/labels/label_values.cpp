// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_values.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValues = 4096;
constexpr std::size_t kMostText = 2000;

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
  const auto value = realIn(numberAndUnit(text).first);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

constexpr std::size_t kMostElements = 1000;
constexpr int kMostDepth = 80;

void collect(const json& value, std::string_view name, std::string_view except, int depth,
             std::vector<const json*>& found) {
  if (depth > kMostDepth || found.size() >= kMostElements) return;
  if (value.is_array())
    for (const json& item : value) collect(item, name, except, depth + 1, found);
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    if (!except.empty() && key == except) continue;
    if (key == name)
      for (const json* item : labelList(&member))
        if (found.size() < kMostElements) found.push_back(item);
    collect(member, name, except, depth + 1, found);
  }
}

}  // namespace

bool isOneOf(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

std::vector<const json*> labelList(const json* value) {
  if (value == nullptr) return {};
  if (!value->is_array()) return {value};
  std::vector<const json*> elements;
  for (const json& element : *value) elements.push_back(&element);
  return elements;
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
    if (isOneOf(upperCase(text), {"", "N/A", "NULL", "UNK", "UNKNOWN"})) return std::nullopt;
    return text;
  }
  if (value->is_number_integer()) return std::to_string(value->get<std::int64_t>());
  if (value->is_number()) return numberText(value->get<double>());
  if (value->is_boolean()) return value->get<bool>() ? "true" : "false";
  return std::nullopt;
}

std::vector<std::string> labelTexts(const json* value) {
  std::vector<std::string> texts;
  for (const json* item : labelList(unwrapped(value)))
    if (texts.size() < kMostValues) texts.push_back(labelText(item).value_or(""));
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
  const std::vector<const json*> items = labelList(unwrapped(value));
  if (items.size() > kMostValues) return {};
  std::vector<double> numbers;
  for (const json* item : items) {
    const auto number = labelNumber(item);
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

std::string labelUnit(const json* value) {
  if (value == nullptr) return "";
  if (value->is_array()) {
    // All of a list, each once: one that mixes units has none of those that are known.
    std::vector<std::string> units;
    for (const json& item : *value)
      if (const std::string unit = labelUnit(&item);
          !unit.empty() && std::find(units.begin(), units.end(), unit) == units.end())
        units.push_back(unit);
    return joined(units);
  }
  if (value->is_string())
    return upperCase(numberAndUnit(value->get_ref<const std::string&>()).second);
  const json* unit = labelMember(value, "unit");
  if (unit == nullptr || !unit->is_string()) return "";
  return upperCase(trimmed(unit->get_ref<const std::string&>()));
}

std::optional<BitPattern> bitPattern(std::string_view text) {
  int base = 16;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
  } else {
    const auto hash = text.find('#');
    if (hash == std::string_view::npos) return std::nullopt;
    base = numberIn<int>(text.substr(0, hash)).value_or(0);
    if (base != 2 && base != 16) return std::nullopt;
    text = text.substr(hash + 1);
    if (text.ends_with('#')) text.remove_suffix(1);
  }
  const auto bits = numberIn<std::uint64_t>(text, base);
  if (!bits) return std::nullopt;
  return BitPattern{*bits, static_cast<int>(text.size()) * (base == 16 ? 4 : 1)};
}

std::vector<std::pair<std::string, const json*>> labelGroups(LabelFormat format,
                                                             const json& label) {
  std::vector<std::pair<std::string, const json*>> groups;
  const json* parent = format == LabelFormat::kVicar  ? labelMember(&label, "PROPERTY")
                       : format == LabelFormat::kPds3 ? &label
                                                      : nullptr;
  if (parent == nullptr || !parent->is_object()) return groups;
  for (const auto& [key, member] : parent->items()) {
    if (!member.is_object()) continue;
    if (format == LabelFormat::kPds3 && !member.contains("_type")) continue;
    // The second group of a name is called NAME_2.
    const auto name = labelText(labelMember(&member, "_container_name"));
    groups.emplace_back(name.value_or(key), &member);
  }
  return groups;
}

const json* labelItem(LabelFormat format, const json& label,
                      std::initializer_list<std::string_view> groups, std::string_view key) {
  const auto named_groups = labelGroups(format, label);
  for (const std::string_view name : groups) {
    const auto group = std::ranges::find(named_groups, name, [](const auto& named_group) {
      return std::string_view(named_group.first);
    });
    if (group == named_groups.end()) continue;
    if (const json* value = labelMember(group->second, key)) return value;
  }
  return nullptr;
}

std::vector<const json*> elementsNamed(const json& label, std::string_view name,
                                       std::string_view except) {
  std::vector<const json*> found;
  collect(label, name, except, 0, found);
  return found;
}

}  // namespace boresight::sessions
