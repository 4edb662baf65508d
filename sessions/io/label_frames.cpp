// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/label_frames.h"

#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "sessions/io/label_camera.h"
#include "sessions/io/label_groups.h"
#include "sessions/io/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr double kMostQuaternionError = 1e-3;
constexpr double kLargest_m = 1e9;
constexpr std::size_t kMostFrames = 200;

FrameName namedFrame(const json& group, const char* name, const char* index) {
  FrameName frame;
  frame.name = labelText(labelMember(&group, name)).value_or("");
  for (const double one : labelNumbers(labelMember(&group, index)))
    if (one == std::floor(one) && std::abs(one) < 9e15)
      frame.index.push_back(static_cast<std::int64_t>(one));
  return frame;
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
    add(namedFrame(*group, "COORDINATE_SYSTEM_NAME", "COORDINATE_SYSTEM_INDEX"),
        namedFrame(*group, "REFERENCE_COORD_SYSTEM_NAME", "REFERENCE_COORD_SYSTEM_INDEX"),
        poseOf(labelVector(labelMember(group, "ORIGIN_OFFSET_VECTOR")),
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
FrameName elementReference(const json& definition, const std::vector<const json*>& all) {
  const json* reference = labelMember(&definition, "Coordinate_Space_Reference");
  if (const json* space = labelMember(reference, "Coordinate_Space_Indexed"))
    return indexedFrame(*space);
  const auto id =
      labelText(labelPath(reference, {"Local_Internal_Reference", "local_identifier_reference"}));
  if (!id) return {};
  for (const json* other : all)
    for (const std::string& known : labelTexts(labelMember(other, "local_identifier")))
      if (known == *id)
        if (const json* space =
                labelPath(other, {"Coordinate_Space_Present", "Coordinate_Space_Indexed"}))
          return indexedFrame(*space);
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
    add(indexedFrame(*present), elementReference(*definition, definitions), pose, frames, flags);
  }
}

}  // namespace

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
