// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// A statement of a label, for provenance and for display.
struct LabelItem {
  std::string name;   ///< the label's own keyword, e.g. "PRODUCT_ID"
  std::string value;  ///< of several values, separated by ", "

  bool operator==(const LabelItem&) const = default;
};

/// A frame whose pose a label states. For display only.
struct LabelFrame {
  FrameName frame;
  FrameName reference;
  Pose reference_from_frame;
};

/// The part of the detector that an image holds.
struct LabelSubframe {
  int first_sample = 0;  ///< of the detector, counted from 0
  int first_line = 0;
  double samples_per_pixel = 1.0;  ///< detector samples per image pixel
  double lines_per_pixel = 1.0;

  /// Whether the image is the whole detector at full resolution.
  bool whole() const {
    return first_sample == 0 && first_line == 0 && samples_per_pixel == 1.0 &&
           lines_per_pixel == 1.0;
  }
};

/// The data of a planetary image's label that Boresight uses or shows.
struct ImageLabel {
  std::string format;  ///< "VICAR", "PDS3" or "PDS4"
  /// Mission, instrument, product, time and the like, in this order, as far as the label has them.
  std::vector<LabelItem> identifiers;
  int width = 0;  ///< of the image, px
  int height = 0;
  /// The camera of the image as it is stored: sub-frame and down-sampling applied; the centre of
  /// the top-left pixel is (0, 0). Empty with the reason in `camera_remark`.
  std::optional<CameraFile> camera;
  /// One sentence: the label has no camera model, or one that does not fit the image.
  std::string camera_remark;
  /// Other statements of the label on its camera model: its source, filter, solution.
  std::vector<LabelItem> camera_items;
  std::optional<LabelSubframe> subframe;  ///< as stated by the label
  std::optional<int> bit_depth;           ///< bits that the samples use, as the label states them
  std::string bayer_pattern;              ///< of a mosaic not yet converted to colours; else empty
  std::vector<LabelFrame> frames;
  std::vector<std::string> flags;  ///< for the operator, a sentence each
};

/// Whether the file begins like a VICAR, PDS3 or PDS4 label; false also when it cannot be read.
bool hasImageLabel(const std::filesystem::path& file);

/// Reads the label of a VICAR, PDS3 or PDS4 image (of PDS3 and PDS4 also a label next to the pixel
/// file). InputError when there is no label, or it is damaged; a camera model that is missing or
/// does not fit is not an error here.
ImageLabel readImageLabel(const std::filesystem::path& file);

}  // namespace boresight::sessions
