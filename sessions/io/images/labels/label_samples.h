// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"

namespace boresight::sessions {

/// Samples within `tolerance` of `value` are without a measurement.
struct InvalidValue {
  double value = 0.0;
  double tolerance = 0.0;
};

/// Adds the constant that a label states, or each of a list: a number, or the bits of one as
/// 16#FF7FFFFB#, 0xFF7FFFFB or 2#...#. Up to 32 bits of a floating-point number are those of a
/// 32-bit one; integers may have either sign. From 10^30 on a number is compared to its written
/// digits (-3.402823e+38 for the lowest 32-bit number); smaller ones are exact. At most 32 values.
void addInvalidValues(const nlohmann::json* stated, bool floating, int sample_bits,
                      std::vector<InvalidValue>& values);

/// OpenCV's integer luma of 16-bit colour.
constexpr std::uint16_t luma(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return static_cast<std::uint16_t>((9798u * red + 19235u * green + 3735u * blue + 16384u) >> 15);
}

/// The samples of an image with a label as 8 or 16 bits of gray, by the stated rule.
struct LabelSamples {
  int width = 0;
  int height = 0;
  int bands = 1;                      ///< of the file: 1, or 3 (red, green, blue, turned into luma)
  int sample_bits = 8;                ///< of `values`: 8 or 16
  std::vector<std::uint16_t> values;  ///< row-major
  /// The file's own value is offset + scale * value.
  double offset = 0.0;
  double scale = 1.0;
  bool quantized = false;          ///< the samples were not whole numbers of 0 .. 65535
  int highest = 0;                 ///< of all samples, before luma
  std::int64_t invalid_count = 0;  ///< samples without a value; they are 0
  std::string rule;                ///< how samples became `values`; empty: as they are
  std::shared_ptr<const ImageLabel> label;
  std::string sha256;  ///< of all files read
};

/// Whole numbers of 0 .. 65535 stay as they are. All others are quantized: the lowest valid sample
/// becomes 0, the highest 65535, those between them linearly. Samples that the label declares
/// missing or invalid, and NaN samples, become 0 and are counted. InputError: other than 1 or 3
/// bands, a product that is not an image, no valid sample at all.
LabelSamples readLabelSamples(const LabelFiles& files);

}  // namespace boresight::sessions
