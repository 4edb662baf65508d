// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/part_source.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {
namespace {

const char* roleName(PartRole role) { return kPartRoleNames[static_cast<std::size_t>(role)]; }

PartRole roleOf(std::string_view name) {
  const auto found = std::find(std::begin(kPartRoleNames), std::end(kPartRoleNames), name);
  return static_cast<PartRole>(found - std::begin(kPartRoleNames));
}

/// Places the part in STATION or CAMERA; returns why it cannot.
PartConcern placeInScene(PartSource& part, const FrameTree& frames) {
  if (part.frame != kStationFrame && part.frame != kCameraFrame) {  // else the pose keeps its bits
    const auto camera = frames.chain(kCameraFrame, part.frame);
    const auto station = frames.chain(kStationFrame, part.frame);
    if (!camera && !station)
      return {"frame", frameText(part.frame) +
                           " is joined to neither CAMERA nor STATION: add the transform that joins "
                           "it (--frames, or transforms of dataset.json)"};
    if (camera && station && camera->links.size() == station->links.size())
      return {"frame", frameText(part.frame) +
                           " is as many transforms from CAMERA as from STATION: place the part in "
                           "the one that it moves with"};
    const bool with_camera = camera && (!station || camera->links.size() < station->links.size());
    part.frame = with_camera ? kCameraFrame : kStationFrame;
    part.frame_from_mesh = (with_camera ? *camera : *station).a_from_b * part.frame_from_mesh;
  }
  if (part.frame == kCameraFrame && part.state.role == PartRole::kMatched)
    return {"role",
            "a part that is fixed to the camera cannot be matched: give it the role "
            "occludes"};
  return {};
}

}  // namespace

std::string partStateText(const PartState& state) {
  return state.present ? roleName(state.role) : "off";
}

std::optional<PartState> changedState(const PartState& state, std::string_view change) {
  if (change == "on" || change == "off") return PartState{state.role, change == "on"};
  const PartRole role = roleOf(change);
  if (static_cast<std::size_t>(role) >= std::size(kPartRoleNames)) return std::nullopt;
  return PartState{role, true};
}

std::string partName(const PartSource& part) {
  return part.name.empty() ? part.mesh.stem().string() : part.name;
}

std::string partText(const PartSource& part) {
  return partName(part) + ": " + roleName(part.state.role) + ", fixed to " + frameText(part.frame) +
         (part.state.present ? "" : ", off");
}

bool anyMatched(std::span<const PartSource> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [](const PartSource& part) { return part.state.matched(); });
}

std::size_t partOfName(std::span<const PartSource> parts, const std::string& name,
                       const std::filesystem::path& file, const std::string& place) {
  std::vector<std::string> names;
  for (const PartSource& part : parts) names.push_back(partName(part));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(file, place, "there is no part '" + name + "'; there are: " + joined(names));
  if (std::count(names.begin(), names.end(), name) > 1)
    throw InputError(file, place,
                     "several parts are called '" + name + "': give each a unique 'name'");
  return static_cast<std::size_t>(found - names.begin());
}

PartConcern partConcern(PartSource part, const FrameTree& frames) {
  return placeInScene(part, frames);
}

PartSource placedPart(PartSource part, const FrameTree& frames) {
  const PartConcern concern = placeInScene(part, frames);
  if (!concern.member.empty()) throw InputError(part.mesh, concern.member, concern.reason);
  return part;
}

nlohmann::ordered_json partFrameJson(const FrameName& frame) {
  return frame.index.empty() ? nlohmann::ordered_json(frame.name) : toJson(frame);
}

FrameName readPartFrame(const JsonReader& json) {
  return json.value().is_string() ? FrameName{json.nonEmptyText(), {}} : readFrameName(json);
}

PartState readPartState(const JsonReader& json) {
  PartState state;
  if (const auto role = json.find("role")) {
    if (json.has("match")) json.failMember("match", "cannot be combined with 'role'");
    state.role = roleOf(role->choice({kPartRoleNames[0], kPartRoleNames[1], kPartRoleNames[2]}));
  } else if (const auto match = json.find("match")) {
    state.role = match->boolean() ? PartRole::kMatched : PartRole::kOccludes;
  }
  if (const auto present = json.find("present")) state.present = present->boolean();
  return state;
}

}  // namespace boresight::sessions
