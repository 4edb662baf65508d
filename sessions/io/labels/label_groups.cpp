// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_groups.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostElements = 1000;
constexpr int kMostDepth = 80;

void collect(const json& value, std::string_view name, std::string_view except, int depth,
             std::vector<const json*>& found) {
  if (depth > kMostDepth || found.size() >= kMostElements) return;
  if (value.is_array())
    for (const json& one : value) collect(one, name, except, depth + 1, found);
  if (!value.is_object()) return;
  for (auto member = value.begin(); member != value.end(); ++member) {
    if (!except.empty() && member.key() == except) continue;
    if (member.key() == name) {
      if (!member->is_array() && found.size() < kMostElements) found.push_back(&*member);
      if (member->is_array())
        for (const json& one : *member)
          if (found.size() < kMostElements) found.push_back(&one);
    }
    collect(*member, name, except, depth + 1, found);
  }
}

}  // namespace

std::vector<std::pair<std::string, const json*>> labelGroups(LabelFormat format,
                                                             const json& label) {
  std::vector<std::pair<std::string, const json*>> groups;
  const json* parent = format == LabelFormat::kVicar  ? labelMember(&label, "PROPERTY")
                       : format == LabelFormat::kPds3 ? &label
                                                      : nullptr;
  if (parent == nullptr || !parent->is_object()) return groups;
  for (auto member = parent->begin(); member != parent->end(); ++member) {
    if (!member->is_object()) continue;
    if (format == LabelFormat::kPds3 && !member->contains("_type")) continue;
    // The second group of a name is called NAME_2.
    const auto name = labelText(labelMember(&*member, "_container_name"));
    groups.emplace_back(name.value_or(member.key()), &*member);
  }
  return groups;
}

const json* labelGroup(LabelFormat format, const json& label,
                       std::initializer_list<std::string_view> names) {
  const auto groups = labelGroups(format, label);
  for (const std::string_view name : names)
    for (const auto& [found, group] : groups)
      if (found == name) return group;
  return nullptr;
}

const json* labelItem(LabelFormat format, const json& label,
                      std::initializer_list<std::string_view> groups, std::string_view key) {
  if (groups.size() == 0) return labelMember(&label, key);
  for (const std::string_view name : groups)
    if (const json* value = labelMember(labelGroup(format, label, {name}), key)) return value;
  return nullptr;
}

std::vector<const json*> elementsNamed(const json& label, std::string_view name,
                                       std::string_view except) {
  std::vector<const json*> found;
  collect(label, name, except, 0, found);
  return found;
}

}  // namespace boresight::sessions
