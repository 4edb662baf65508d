// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/camera_of_file.h"

#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/labels/image_label.h"

namespace boresight::sessions {

namespace {

/// Camera files of ROS, Kalibr and OpenCV differ in the names and the meaning of their values.
void requireOwnFormat(const std::filesystem::path& file) {
  const std::string ending = lowerCase(file.extension().string());
  if (ending == ".yaml" || ending == ".yml" || ending == ".xml")
    throw InputError(file,
                     "a camera is read from a camera.json, a .cahvor file or a labelled image: "
                     "write its values into a camera.json (formats.md)");
}

}  // namespace

CameraFile readCameraFile(const std::filesystem::path& file) {
  if (isCahvorFile(file)) return readCahvorCamera(file);
  if (!hasImageLabel(file)) {
    requireOwnFormat(file);
    return readCameraJson(file);
  }
  const ImageLabel label = readImageLabel(file);
  if (!label.camera) throw InputError(file, label.camera_remark);
  return *label.camera;
}

Camera readCamera(const std::filesystem::path& file) { return readCameraFile(file).camera; }

CameraFile readChosenCamera(const std::filesystem::path& camera_file,
                            const std::filesystem::path& image) {
  if (!camera_file.empty()) return readCameraFile(camera_file);
  if (!hasImageLabel(image))
    throw InputError(
        image, "camera",
        "none is given, and the image has no label with a camera model: give a camera.json");
  const ImageLabel label = readImageLabel(image);
  if (!label.camera)
    throw InputError(image, "camera",
                     label.camera_remark + ": give a camera.json or a .cahvor file with --camera");
  return *label.camera;
}

}  // namespace boresight::sessions
