// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// The camera of a file of any kind: camera.json or the metadata of a raw image (readCameraJson), a
/// text file of calibration named .cahv, .cahvor or .cahvore, or an image with a VICAR, PDS3 or
/// PDS4 label, for the camera model in it. The camera is prepared for projection. InputError.
CameraFile readCameraFile(const std::filesystem::path& file);
/// The camera alone, without its reference frame.
Camera readCamera(const std::filesystem::path& file);

/// The camera of `camera_file` or, where that name is empty, of the image's own label. InputError,
/// also when there is neither.
CameraFile readChosenCamera(const std::filesystem::path& camera_file,
                            const std::filesystem::path& image);

}  // namespace boresight::sessions
