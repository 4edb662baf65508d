// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/labels/label_files.h"
#include "sessions/io/labels/label_layout.h"

namespace boresight::sessions {

/// An image with a label as GDAL opens it, from bytes in memory alone: nothing that a label says
/// makes it read another file. The label comes as one tree: of VICAR and PDS3 as GDAL's JSON has
/// it (IMAGE at the top also where it stands in an OBJECT = FILE), of PDS4 as readXmlLabel has it.
class LabelRaster {
 public:
  /// The files must outlive it. InputError: a label that is damaged, sizes out of bounds, pixels
  /// that are not all there.
  explicit LabelRaster(const LabelFiles& files);
  ~LabelRaster();
  LabelRaster(const LabelRaster&) = delete;
  LabelRaster& operator=(const LabelRaster&) = delete;

  int width() const;
  int height() const;
  int bands() const;
  SampleType type() const;
  const nlohmann::json& label() const;
  /// The label of the VICAR header inside a PDS3 file; null when there is none.
  const nlohmann::json& vicarLabel() const;
  /// Of several images in the label, which one this is; else empty.
  const std::string& remark() const;
  /// Samples of a row of a band (from 0), exact in double. InputError.
  void readRow(int band, int row, std::vector<double>& samples) const;

 private:
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

}  // namespace boresight::sessions
