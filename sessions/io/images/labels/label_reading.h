// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"
#include "sessions/io/images/labels/label_raster.h"
#include "sessions/io/images/labels/label_samples.h"

namespace boresight::sessions {

/// What Boresight uses of a label.
struct LabelReading {
  ImageLabel label;
  std::vector<InvalidValue> invalid;  ///< samples that stand for no measurement
  std::string derived_type;           ///< what a product is that is not a picture, e.g. "XYZ_MAP"
};

/// Reads the trees of LabelRaster. Never fails: what is missing or wrong is absent, with a flag
/// where the operator should know.
LabelReading readLabelTree(LabelFormat format, const nlohmann::json& label,
                           const nlohmann::json& vicar_label, const LabelPicture& picture);

/// The same for an opened image.
LabelReading readLabel(const LabelFiles& files, const LabelRaster& raster);

}  // namespace boresight::sessions
