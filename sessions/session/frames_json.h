// SPDX-License-Identifier: Apache-2.0
// What a case knows of frames and of its image's label, as members of its JSON.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/frame_transform.h"
#include "sessions/io/labels/image_label.h"
#include "sessions/session/case_json.h"

namespace boresight::sessions {

/// {"name", "index", "camera_from_reference"}; reading it back gives the same bits.
nlohmann::ordered_json toJson(const CameraReference& reference);
CameraReference readCameraReference(const JsonReader& json);

/// {"name", "index", "joined_by": {"target", "source", "target_from_source", "comment", "file",
/// "sha256"}}: the file's name alone, since its numbers are here.
nlohmann::ordered_json toJson(const StationFrame& frame);
StationFrame readStationFrame(const JsonReader& json);

/// An array of [keyword, value].
nlohmann::ordered_json toJson(const std::vector<LabelItem>& label);
std::vector<LabelItem> readLabelItems(const JsonReader& json);

}  // namespace boresight::sessions
