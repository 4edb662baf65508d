// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "sessions/io/camera_file.h"

namespace boresight::sessions {

/// The camera of `camera_file`, or where that is empty of the image's own label. InputError, also
/// when there is neither.
CameraFile readChosenCamera(const std::filesystem::path& camera_file,
                            const std::filesystem::path& image);

}  // namespace boresight::sessions
