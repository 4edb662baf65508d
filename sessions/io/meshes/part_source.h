// SPDX-License-Identifier: Apache-2.0
// Parts of a station as files describe them, and their states.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/io/cameras/frame_tree.h"

namespace boresight::sessions {

/// Role of a part for the localizer: matched in the image, rendered in front of other parts, or
/// nothing.
enum class PartRole { kMatched, kOccludes, kIgnored };
inline constexpr const char* kPartRoleNames[] = {"matched", "occludes", "ignored"};

/// State of a part in an image.
struct PartState {
  PartRole role = PartRole::kMatched;
  bool present = true;  ///< false: switched off, such as an open lid

  /// Whether the part is passed to the core.
  bool used() const { return present && role != PartRole::kIgnored; }
  bool matched() const { return present && role == PartRole::kMatched; }

  bool operator==(const PartState&) const = default;
};

/// "matched", "occludes", "ignored", or "off".
std::string partStateText(const PartState& state);
/// The state after "off", "on", or a role, which also switches the part on; empty for other text.
std::optional<PartState> changedState(const PartState& state, std::string_view change);
/// The texts that changedState accepts, for help and messages.
inline constexpr const char* kStateChanges = "off, on, matched, occludes, ignored";

/// One part of a station; the mesh is read when the scene is.
struct PartSource {
  std::filesystem::path mesh;
  std::string mesh_unit;            ///< "" where the format carries its unit
  std::string name;                 ///< "": the file's stem
  FrameName frame = kStationFrame;  ///< that the part is fixed to
  Pose frame_from_mesh;
  double normal_threshold_rad = ScenePart().normal_threshold_rad;
  double depth_threshold_m = ScenePart().depth_threshold_m;
  PartState state;
  std::optional<double> albedo;  ///< mean reflectance, 0 .. 1; 1 where not stated

  bool operator==(const PartSource&) const = default;
};

/// The name, or the file's stem.
std::string partName(const PartSource& part);
/// "lid: matched, fixed to STATION".
std::string partText(const PartSource& part);

/// Whether any part is matched.
bool anyMatched(std::span<const PartSource> parts);

/// Index of the part of this name. InputError about `file` and `place` when no part, or several,
/// have it.
std::size_t partOfName(std::span<const PartSource> parts, const std::string& name,
                       const std::filesystem::path& file, const std::string& place);

/// Reason why a part cannot be placed in the scene, and the member that it is about.
struct PartConcern {
  std::string member;  ///< "frame" or "role"; "" without a concern
  std::string reason;
};
/// Why a part cannot be placed: its frame is joined to neither CAMERA nor STATION, or equally near
/// to both; or it is matched and fixed to the camera.
PartConcern partConcern(PartSource part, const FrameTree& frames);

/// The part in STATION or CAMERA, whichever fewer transforms join to its frame. InputError when
/// there is a partConcern.
PartSource placedPart(PartSource part, const FrameTree& frames);

/// "CAMERA", or {"name", "index"} of a frame with an index.
nlohmann::ordered_json partFrameJson(const FrameName& frame);
/// Inverse of partFrameJson. InputError.
FrameName readPartFrame(const JsonReader& json);

/// `role`, or `match` of older files, and `present`. InputError when both are given.
PartState readPartState(const JsonReader& json);

}  // namespace boresight::sessions
