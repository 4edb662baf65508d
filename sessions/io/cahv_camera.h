// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {

/// A camera of the CAHV family: its vectors in a reference frame, as labels and camera.json give
/// them, into the camera's own frame. `json` is told what is wrong with them; InputError.
CameraFile readCahvCamera(CameraModel model, const JsonReader& json);

/// The vectors in the reference frame; in the camera's own where there is none.
nlohmann::ordered_json cahvJson(const CameraFile& file);

}  // namespace boresight::sessions
