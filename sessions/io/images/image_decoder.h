// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace boresight::sessions {

/// InputError for an image without pixels, or larger than kMaxImageSide_px and kMaxImagePixels
/// allow.
void requireImageSize(const std::filesystem::path& file, std::int64_t width, std::int64_t height);

/// "PNG", "JPEG" or "TIFF" by the signature that the bytes begin with; nullptr for other files.
const char* imageContainerOf(std::span<const std::uint8_t> bytes);

struct ImageHeader {
  std::string container;  ///< as of imageContainerOf
  int width = 0;          ///< of the file's first image
  int height = 0;
};

/// Reads no pixels. InputError: another format, a truncated file, a size beyond the limits.
ImageHeader readImageHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

struct DecodedImage {
  std::string container;  ///< as of imageContainerOf
  /// 8 or 16 bits; gray, gray and alpha, BGR or BGRA; lines and samples as they are stored.
  cv::Mat pixels;
  /// For the operator: an orientation that is not applied, further pages, damage.
  std::vector<std::string> notes;
  bool mosaic = false;  ///< the file says that its samples are a mosaic of colours
};

/// Decodes a PNG, JPEG or TIFF with GDAL's drivers. Palettes become colours, fewer than 8 bits are
/// spread over 8, and where 0 is white the values are inverted. InputError: errors of
/// readImageHeader, damaged pixels, a preview in front of the image, samples other than unsigned
/// integers of at most 8, or of 16 bits, colours other than gray and RGB.
DecodedImage decodeImage(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
