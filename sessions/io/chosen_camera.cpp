// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/chosen_camera.h"

#include "sessions/io/errors.h"
#include "sessions/io/labels/image_label.h"

namespace boresight::sessions {

CameraFile readChosenCamera(const std::filesystem::path& camera_file,
                            const std::filesystem::path& image) {
  if (!camera_file.empty()) return readCameraFile(camera_file);
  if (!hasImageLabel(image))
    throw InputError(image, "camera",
                     "none is given, and the image has no label that could tell it: give a "
                     "camera.json");
  const ImageLabel label = readImageLabel(image);
  if (!label.camera)
    throw InputError(image, "camera",
                     label.camera_remark + ": give a camera.json or a .cahvor file with --camera");
  return *label.camera;
}

}  // namespace boresight::sessions
