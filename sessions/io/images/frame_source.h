// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/io/images/image_file.h"

namespace boresight::sessions {

/// One image of a sequence.
struct Frame {
  std::string name;  ///< unique in its sequence
  std::optional<GrayImage> image;
  std::string problem;  ///< why there is no image; empty otherwise
};

/// The images of a sequence in their order.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Number of frames; for a video the number that its file states, or 0.
  virtual std::int64_t count() const = 0;
  /// The next frame; empty after the last one.
  virtual std::optional<Frame> next() = 0;
  /// Skips the next frame without reading its image; does nothing after the last one.
  virtual void skip() = 0;
  /// For the operator, about the sequence as far as it was read: what its file states that is not
  /// applied, damage. Complete after the last frame.
  virtual std::vector<std::string> notes() const { return {}; }
};

/// The images of a folder (PNG, JPEG, TIFF and the labelled formats, by the ends of their names),
/// or of a text file, one path a line, relative to the file. Empty lines and lines that begin with
/// # are skipped. Names of a folder are ordered with their numbers by value: 9 before 10.
/// InputError when there is no such folder or file, no image, or an image twice.
std::unique_ptr<FrameSource> openImages(const std::filesystem::path& folder_or_list,
                                        const ImageReadOptions& options = {});

}  // namespace boresight::sessions
