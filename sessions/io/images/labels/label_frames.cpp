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

/// `parts` are the index as numbers, none where a part is no whole number; `text` the same as
/// words.
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

/// The unit of an offset where it is stated: of one in mm no place is read.
std::optional<Eigen::Vector3d> offsetIn_m(const json* value) {
  const std::string unit = labelUnit(value);
  if (!unit.empty() && unit != "M" && unit != "METER" && unit != "METERS") return std::nullopt;
  return labelVector(value);
}

std::optional<Pose> poseOf(const std::optional<Eigen::Vector3d>& offset_m,
                           const std::vector<double>& wxyz) {
  if (!offset_m || wxyz.size() != 4 || !(offset_m->norm() <= kLargest_m)) return std::nullopt;
  const Eigen::Quaterniond rotation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!(std::abs(rotation.norm() - 1.0) <= kMostQuaternionError)) return std::nullopt;
  return Pose{rotation.normalized(), *offset_m};
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
    if (name.find("COORDINATE_SYSTEM") == std::string::npos) continue;
    if (labelMember(group, "ORIGIN_OFFSET_VECTOR") == nullptr &&
        labelMember(group, "ORIGIN_ROTATION_QUATERNION") == nullptr)
      continue;
    const FrameName frame =
        groupFrame(*group, "COORDINATE_SYSTEM_NAME", "COORDINATE_SYSTEM_INDEX", flags);
    const FrameName reference =
        groupFrame(*group, "REFERENCE_COORD_SYSTEM_NAME", "REFERENCE_COORD_SYSTEM_INDEX", flags);
    add(frame, reference,
        poseOf(offsetIn_m(labelMember(group, "ORIGIN_OFFSET_VECTOR")),
               labelNumbers(labelMember(group, "ORIGIN_ROTATION_QUATERNION"))),
        frames, flags);
  }
}

std::vector<double> elementQuaternion(const json* element) {
  std::vector<double> wxyz;
  for (const char* name : {"qcos", "qsin1", "qsin2", "qsin3"})
    if (const auto number = labelNumber(labelMember(element, name))) wxyz.push_back(*number);
  return wxyz;
}

std::optional<Eigen::Vector3d> elementOffset(const json* element) {
  Eigen::Vector3d offset_m;
  int axis = 0;
  for (const char* name : {"x_position", "y_position", "z_position"}) {
    const json* value = labelMember(element, name);
    const auto number = labelNumber(value);
    const std::string unit = labelUnit(value);
    if (!number || (!unit.empty() && unit != "M")) return std::nullopt;
    offset_m[axis++] = *number;
  }
  return offset_m;
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
        poseOf(elementOffset(labelMember(definition, "Vector_Origin_Offset")),
               elementQuaternion(quaternion));
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
  if (stated != nullptr && stated->is_array())
    for (const json& part : *stated) parts.push_back(labelInteger(&part));
  else if (labelText(stated))  // "N/A" is no index
    parts.push_back(labelInteger(stated));
  return frameWith(labelText(labelMember(&group, name)).value_or(""), parts,
                   joined(labelTexts(stated)), flags);
}

FrameName indexedFrame(const json& space, std::vector<std::string>& flags) {
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
