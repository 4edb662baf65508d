// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// Whether the object is the metadata of a raw image of Mars 2020 (an entry of the mission's public
/// image feed): it has `camera_model_component_list`.
bool isRawMetadata(const JsonReader& json);

/// The camera of such an image, in ROVER_NAV_FRAME (site, drive). Sub-frame and scale are already
/// applied to the components. InputError.
CameraFile readRawMetadata(const JsonReader& json);

}  // namespace boresight::sessions
