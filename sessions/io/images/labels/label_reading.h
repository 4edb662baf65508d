// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"
#include "sessions/io/images/labels/label_raster.h"
#include "sessions/io/images/labels/label_samples.h"

namespace boresight::sessions {

/// The data of a label that Boresight uses.
struct LabelReading {
  ImageLabel label;
  std::vector<InvalidValue> invalid;  ///< values of samples without a measurement
  std::string derived_type;           ///< type of a product that is not an image, e.g. "XYZ_MAP"
};

/// Reads the trees of LabelRaster. Never fails: missing or invalid data is absent, with a flag
/// where the operator should know.
LabelReading readLabelTree(LabelFormat format, const nlohmann::json& label,
                           const nlohmann::json& vicar_label, const LabelPicture& picture);

/// The same for an opened image.
LabelReading readLabel(const LabelFiles& files, const LabelRaster& raster);

}  // namespace boresight::sessions
