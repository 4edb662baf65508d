// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/camera.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {

/// Longest side of an image or a camera, px: edge pixels are stored in 16 bits.
inline constexpr int kMaxImageSide_px = 16384;

/// Reads camera.json (`boresight-camera`, version 1): pinhole, brown_conrady with 4, 5 or 8
/// coefficients, kannala_brandt with 4. The camera is prepared for projection. InputError.
Camera readCamera(const std::filesystem::path& file);

/// The same for a camera inside another file, without format and version.
Camera readCamera(const JsonReader& json);

/// What camera.json holds besides format and version; reading it back gives the same bits.
nlohmann::ordered_json toJson(const Camera& camera);

/// Writes camera.json; OutputError.
void writeCamera(const std::filesystem::path& file, const Camera& camera);

/// Name of a model in files, e.g. "brown_conrady".
const char* cameraModelName(CameraModel model);

}  // namespace boresight::sessions
