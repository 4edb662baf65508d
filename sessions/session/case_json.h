// SPDX-License-Identifier: Apache-2.0
// One case inside the session file.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/frame_transform.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/labels/image_label.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

class PathWriter;

nlohmann::ordered_json toJson(const SessionCase& one, const PathWriter& path);
/// The reverse, without whether its id is given twice. InputError.
SessionCase readSessionCase(const JsonReader& json);

/// {"name", "index", "joined_by": {"target", "source", "target_from_source", "comment", "file",
/// "sha256"}}: the file's name alone, since its numbers are here.
nlohmann::ordered_json toJson(const StationFrame& frame);

/// An array of [keyword, value].
nlohmann::ordered_json toJson(const std::vector<LabelItem>& label);

}  // namespace boresight::sessions
