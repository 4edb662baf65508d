// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/images/labels/label_files.h"

namespace boresight::sessions {

/// Storage type of a sample in the file.
struct SampleType {
  int bits = 8;
  bool floating = false;
  bool is_signed = false;
};

/// Layout of the pixels according to their header.
struct LabelPicture {
  int width = 0;
  int height = 0;
  int bands = 1;
  SampleType type;
  std::string remark = {};  ///< which of several images in the label is read; else empty
};

/// An image with a label, opened by GDAL from bytes in memory: no other file is read.
struct LabelRaster {
  LabelPicture picture;
  /// VICAR and PDS3: GDAL's JSON, with IMAGE at the top also if the label has it in an OBJECT =
  /// FILE. PDS4: LabelFiles::elements.
  nlohmann::json label;
  nlohmann::json vicar_label;  ///< of the VICAR header inside a PDS3 file; else null
  /// Reads a row of a band (both from 0), exact in double. InputError.
  std::function<void(int band, int row, std::vector<double>& samples)> readRow;
};

/// `files` must outlive the result. InputError: a damaged label, sizes out of bounds, missing
/// pixels, or samples that GDAL would interpret differently from the label.
LabelRaster openLabelRaster(const LabelFiles& files);

}  // namespace boresight::sessions
