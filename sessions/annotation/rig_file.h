// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "sessions/annotation/marked_view.h"

namespace boresight::sessions {

/// rig.json (`boresight-rig`, version 1): cameras that are solved as one, or images of cameras of a
/// rig that did not move between them. Files are relative to rig.json.
///
///     {"format": "boresight-rig", "version": 1,
///      "views": [{"name": "left", "camera": "left.json", "points": "left_points.json",
///                 "camera_from_rig": [[4x4]]}, ...]}
///
/// InputError, also for no view and for a name given twice.
std::vector<MarkedView> readRig(const std::filesystem::path& file);

}  // namespace boresight::sessions
