// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_camera.h"

#include <cmath>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

/// `parts` are the numbers of the index, empty where a part is not a whole number; `text` is the
/// index as it is written.
FrameName frameWith(std::string name, const std::vector<std::optional<std::int64_t>>& parts,
                    const std::string& text, std::vector<std::string>& flags) {
  FrameName frame{std::move(name), {}};
  for (const auto& part : parts) {
    if (part) {
      frame.index.push_back(*part);
      continue;
    }
    if (!frame.name.empty())
      flags.push_back("the index of the label's frame " + frame.name + ", (" + text +
                      "), is not of whole numbers: the frame counts as one without a name");
    return {};
  }
  return frame;
}

constexpr double kMostQuaternionError = 1e-3;
constexpr double kLargest_m = 1e9;
constexpr std::size_t kMostFrames = 200;

/// Numbers of an offset; none where a unit other than the metre is stated.
std::vector<double> offsetIn_m(const json* value) {
  if (!isOneOf(labelUnit(value), {"", "M", "METER", "METERS"})) return {};
  return labelNumbers(value);
}

std::optional<Pose> poseOf(const std::vector<double>& xyz_m, const std::vector<double>& wxyz) {
  if (xyz_m.size() != 3 || wxyz.size() != 4) return std::nullopt;
  const Eigen::Vector3d offset_m(xyz_m[0], xyz_m[1], xyz_m[2]);
  const Eigen::Quaterniond rotation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!(offset_m.norm() <= kLargest_m) ||
      !(std::abs(rotation.norm() - 1.0) <= kMostQuaternionError))
    return std::nullopt;
  return Pose{rotation.normalized(), offset_m};
}

void add(FrameName frame, FrameName reference, const std::optional<Pose>& pose,
         std::vector<LabelFrame>& frames, std::vector<std::string>& flags) {
  if (frame.name.empty() || frames.size() >= kMostFrames) return;
  if (!pose) {
    flags.push_back("the label's place of " + frameText(frame) +
                    " cannot be read (3 offsets in m and a quaternion of length 1 are needed)");
    return;
  }
  frames.push_back({std::move(frame), std::move(reference), *pose});
}

void groupFrames(LabelFormat format, const json& label, std::vector<LabelFrame>& frames,
                 std::vector<std::string>& flags) {
  for (const auto& [name, group] : labelGroups(format, label)) {
    const json* offset = labelMember(group, "ORIGIN_OFFSET_VECTOR");
    const json* quaternion = labelMember(group, "ORIGIN_ROTATION_QUATERNION");
    if (name.find("COORDINATE_SYSTEM") == std::string::npos ||
        (offset == nullptr && quaternion == nullptr))
      continue;
    const FrameName frame =
        groupFrame(*group, "COORDINATE_SYSTEM_NAME", "COORDINATE_SYSTEM_INDEX", flags);
    const FrameName reference =
        groupFrame(*group, "REFERENCE_COORD_SYSTEM_NAME", "REFERENCE_COORD_SYSTEM_INDEX", flags);
    add(frame, reference, poseOf(offsetIn_m(offset), labelNumbers(quaternion)), frames, flags);
  }
}

/// The numbers of an element's children of these names; without those in a unit not among `units`,
/// if any are given.
std::vector<double> elementNumbers(const json* element, std::initializer_list<const char*> names,
                                   std::initializer_list<std::string_view> units = {}) {
  std::vector<double> numbers;
  for (const char* name : names) {
    const json* value = labelMember(element, name);
    const auto number = labelNumber(value);
    if (number && (units.size() == 0 || isOneOf(labelUnit(value), units)))
      numbers.push_back(*number);
  }
  return numbers;
}

/// The reference is named whole, or by the identifier of another definition.
FrameName elementReference(const json& definition, const std::vector<const json*>& all,
                           std::vector<std::string>& flags) {
  const json* reference = labelMember(&definition, "Coordinate_Space_Reference");
  if (const json* space = labelMember(reference, "Coordinate_Space_Indexed"))
    return indexedFrame(*space, flags);
  const auto id =
      labelText(labelPath(reference, {"Local_Internal_Reference", "local_identifier_reference"}));
  if (!id) return {};
  for (const json* other : all)
    for (const std::string& known : labelTexts(labelMember(other, "local_identifier")))
      if (known == *id)
        if (const json* space =
                labelPath(other, {"Coordinate_Space_Present", "Coordinate_Space_Indexed"}))
          return indexedFrame(*space, flags);
  return {*id, {}};
}

void elementFrames(const json& label, std::vector<LabelFrame>& frames,
                   std::vector<std::string>& flags) {
  const auto definitions = elementsNamed(label, "Coordinate_Space_Definition");
  for (const json* definition : definitions) {
    const json* present =
        labelPath(definition, {"Coordinate_Space_Present", "Coordinate_Space_Indexed"});
    if (present == nullptr) continue;
    const json* quaternion = labelMember(definition, "Quaternion_Plus_Direction");
    std::optional<Pose> pose =
        poseOf(elementNumbers(labelMember(definition, "Vector_Origin_Offset"),
                              {"x_position", "y_position", "z_position"}, {"", "M"}),
               elementNumbers(quaternion, {"qcos", "qsin1", "qsin2", "qsin3"}));
    // "Forward" maps the frame's vectors into its reference, as the groups of PDS3 do.
    const auto direction = labelText(labelMember(quaternion, "rotation_direction"));
    if (pose && direction && upperCase(*direction) != "FORWARD")
      pose->rotation = pose->rotation.conjugate();
    const FrameName frame = indexedFrame(*present, flags);
    const FrameName reference = elementReference(*definition, definitions, flags);
    add(frame, reference, pose, frames, flags);
  }
}

}  // namespace

FrameName groupFrame(const json& group, std::string_view name, std::string_view index,
                     std::vector<std::string>& flags) {
  const json* stated = labelMember(&group, index);
  std::vector<std::optional<std::int64_t>> parts;
  for (const json* part : labelList(stated))
    if (part != stated || labelText(part))  // "N/A" alone is no index
      parts.push_back(labelInteger(part));
  return frameWith(labelText(labelMember(&group, name)).value_or(""), parts,
                   joined(labelTexts(stated)), flags);
}

FrameName indexedFrame(const json& space, std::vector<std::string>& flags) {
  std::vector<std::optional<std::int64_t>> parts;
  std::vector<std::string> texts;
  for (const json* index : labelList(labelMember(&space, "Coordinate_Space_Index"))) {
    const json* value =
        labelMember(index, {"index_value_number", "index_value_string", "index_value"});
    parts.push_back(labelInteger(value));
    texts.push_back(labelText(value).value_or("N/A"));
  }
  return frameWith(labelText(labelMember(&space, "coordinate_space_frame_type")).value_or(""),
                   parts, joined(texts), flags);
}

std::vector<LabelFrame> labelFrames(LabelFormat format, const json& label,
                                    std::vector<std::string>& flags) {
  std::vector<LabelFrame> frames;
  if (format == LabelFormat::kPds4)
    elementFrames(label, frames, flags);
  else
    groupFrames(format, label, frames, flags);
  return frames;
}

}  // namespace boresight::sessions
