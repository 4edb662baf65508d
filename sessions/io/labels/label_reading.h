// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/labels/image_label.h"
#include "sessions/io/labels/label_files.h"
#include "sessions/io/labels/label_samples.h"

namespace boresight::sessions {

class LabelRaster;

/// What the pixels are, by their header.
struct LabelPicture {
  int width = 0;
  int height = 0;
  int bands = 1;
  int sample_bits = 8;
  bool floating = false;    ///< samples are floating-point numbers
  std::string remark = {};  ///< of several images in the label, which one this is; else empty
};

/// All that a label says which Boresight uses: for people, and for whoever reads the samples.
struct LabelReading {
  ImageLabel label;
  std::vector<InvalidValue> invalid;  ///< samples that stand for no measurement
  std::string derived_type;           ///< what a product is that is not a picture, e.g. "XYZ_MAP"
};

/// Understands the trees of LabelRaster: `vicar_label` is that of the header inside a PDS3 file, or
/// null. Never fails: what is missing or wrong is absent, with a flag where a person should know.
LabelReading readLabelTree(LabelFormat format, const nlohmann::json& label,
                           const nlohmann::json& vicar_label, const LabelPicture& picture);

/// The same for an opened image.
LabelReading readLabel(const LabelFiles& files, const LabelRaster& raster);

}  // namespace boresight::sessions
