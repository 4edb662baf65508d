// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {

/// Of an image with a label, as the file has them.
enum class SampleType { kUint8, kInt8, kUint16, kInt16, kUint32, kInt32, kFloat, kDouble };

const char* sampleTypeName(SampleType type);  ///< "16-bit signed integers"
inline bool isFloating(SampleType type) { return type >= SampleType::kFloat; }
int bitsOf(SampleType type);

/// Where a reader takes the samples from; in bytes.
struct RasterLayout {
  int width = 0;
  int height = 0;
  int bands = 1;
  bool little_endian = false;
  std::uint64_t offset = 0;  ///< of the first sample in its file
  std::int64_t pixel_step = 0;
  std::int64_t line_step = 0;
  std::int64_t band_step = 0;
  SampleType type = SampleType::kUint8;
};

/// InputError where GDAL would read other samples of a PDS3 image than `label` (GDAL's tree, IMAGE
/// at its top) states: another type, byte order, size, order of bands, or offset. GDAL does not
/// know all of them, and takes the first statement of a key, the tree the last.
void requireStatedLayout(const LabelFiles& files, const nlohmann::json& label,
                         const RasterLayout& layout);

/// InputError where a VICAR label's sizes contradict each other (a record is NBB bytes and N1
/// samples, the label a number of records), its items at the file's end are not all there, or
/// every line of every band, or every pixel, has a prefix. Of the layout size and type count.
void requireStatedRecords(const LabelFiles& files, const nlohmann::json& label,
                          const RasterLayout& layout);

}  // namespace boresight::sessions
