// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/chosen_camera.h"

#include "sessions/io/errors.h"
#include "sessions/io/image_label.h"

namespace boresight::sessions {

CameraFile readChosenCamera(const std::filesystem::path& camera_file,
                            const std::filesystem::path& image) {
  if (!camera_file.empty()) return readCameraFile(camera_file);
  if (!hasImageLabel(image))
    throw InputError(image, "camera",
                     "none is given, and the image has no label that could tell it: give a "
                     "camera.json");
  return readLabelCamera(image);
}

}  // namespace boresight::sessions
