// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_frame_names.h"

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

/// `parts` are the index as numbers, none where a part is no whole number; `text` the same as
/// words.
FrameName frameWith(std::string name, const std::vector<std::optional<std::int64_t>>& parts,
                    const std::string& text, std::string& flag) {
  FrameName frame{std::move(name), {}};
  for (const auto& part : parts) {
    if (part) {
      frame.index.push_back(*part);
      continue;
    }
    if (!frame.name.empty())
      flag = "the index of the label's frame " + frame.name + ", (" + text +
             "), is not of whole numbers: the frame counts as one without a name";
    return {};
  }
  return frame;
}

}  // namespace

FrameName groupFrame(const json& group, std::string_view name, std::string_view index,
                     std::string& flag) {
  const json* stated = labelMember(&group, index);
  std::vector<std::optional<std::int64_t>> parts;
  if (stated != nullptr && stated->is_array())
    for (const json& part : *stated) parts.push_back(labelInteger(&part));
  else if (labelText(stated))  // "N/A" is no index
    parts.push_back(labelInteger(stated));
  return frameWith(labelText(labelMember(&group, name)).value_or(""), parts,
                   joined(labelTexts(stated)), flag);
}

FrameName indexedFrame(const json& space, std::string& flag) {
  std::vector<std::optional<std::int64_t>> parts;
  std::vector<std::string> texts;
  const auto add = [&](const json& index) {
    const json* value =
        labelMember(&index, {"index_value_number", "index_value_string", "index_value"});
    parts.push_back(labelInteger(value));
    texts.push_back(labelText(value).value_or("N/A"));
  };
  const json* indices = labelMember(&space, "Coordinate_Space_Index");
  if (indices != nullptr && indices->is_array())
    for (const json& index : *indices) add(index);
  else if (indices != nullptr)
    add(*indices);
  return frameWith(labelText(labelMember(&space, "coordinate_space_frame_type")).value_or(""),
                   parts, joined(texts), flag);
}

}  // namespace boresight::sessions
