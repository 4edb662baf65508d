// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/image_label.h"

#include "sessions/io/errors.h"
#include "sessions/io/labels/label_raster.h"
#include "sessions/io/labels/label_reading.h"

namespace boresight::sessions {

bool hasImageLabel(const std::filesystem::path& file) { return labelFileOf(file).has_value(); }

ImageLabel readImageLabel(const std::filesystem::path& file) {
  const LabelFiles files = readLabelFiles(labelFileOf(file).value_or(file));
  const LabelRaster raster(files);
  return readLabel(files, raster).label;
}

CameraFile readLabelCamera(const std::filesystem::path& file) {
  const ImageLabel label = readImageLabel(file);
  if (!label.camera) throw InputError(file, label.camera_remark);
  return *label.camera;
}

}  // namespace boresight::sessions
