// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/image.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {

struct ImageLabel;

inline constexpr std::size_t kMaxImageFileBytes = 1024 * kMegabyte;
/// Most pixels of an image (134 million), to bound memory; its sides have a limit of their own,
/// kMaxImageSide_px.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 27;

/// Samples that are mapped to 0 and 255: linearly between them, clamped beyond.
struct GrayLevels {
  int black = 0;  ///< less than white
  int white = 255;

  bool operator==(const GrayLevels&) const = default;
};

/// Colours of a mosaic's first two lines, two pixels each.
enum class BayerPattern { kRggb, kBggr, kGrbg, kGbrg };
inline constexpr const char* kBayerPatternNames[] = {"rggb", "bggr", "grbg", "gbrg"};
/// The pattern of this name; empty for an unknown name.
std::optional<BayerPattern> bayerPatternNamed(std::string_view name);

struct ImageReadOptions {
  /// Bits that the samples use, 1 .. 16. Empty: those that the label states, else those of the
  /// file (8 or 16).
  std::optional<int> bit_depth;
  /// Instead of the linear rule: the 8-bit value of every sample 0 .. 2^n - 1; empty: linear.
  std::vector<std::uint8_t> table = {};
  /// The table given by two numbers; not together with `table`.
  std::optional<GrayLevels> levels = {};
  /// The samples are a Bayer mosaic: colours are interpolated first (OpenCV, edge-aware).
  std::optional<BayerPattern> bayer = {};

  bool operator==(const ImageReadOptions&) const = default;
};

/// The 8-bit gray image that the core uses, and its provenance.
struct GrayImage {
  std::filesystem::path file;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< row-major, width * height
  /// Row-major, blue, green and red of each pixel, by the same rule; empty: the file has no colour.
  std::vector<std::uint8_t> color;

  std::string container;  ///< "PNG", "JPEG", "TIFF", "VICAR", "PDS3", "PDS4"
  int channels = 1;       ///< of the file: 1 gray, 2 gray + alpha, 3 colour, 4 colour + alpha
  int sample_bits = 8;    ///< of the decoded samples: 8 or 16
  int bit_depth = 8;      ///< n of the rule
  bool bit_depth_stated = false;            ///< requested, not taken from the file
  bool bit_depth_of_label = false;          ///< stated by the file's label, or made by its rule
  std::string rule;                         ///< how samples became 8 bit, for provenance
  std::shared_ptr<const ImageLabel> label;  ///< of a VICAR, PDS3 or PDS4 image, else null
  std::vector<std::string> notes;           ///< for the operator, on its file and samples
  std::string file_sha256;    ///< of a label and the file of its pixels: of both together
  std::string pixels_sha256;  ///< of `pixels`
  std::string color_sha256;   ///< of `color`; empty: the file has no colour

  ImageView view() const { return {pixels.data(), width, height, width}; }
  /// Without data where there is no colour.
  ColorView colorView() const {
    if (color.empty()) return {};
    return {color.data(), width, height, std::ptrdiff_t{ColorView::kChannels} * width};
  }
};

/// Reads a PNG, JPEG or TIFF of 8 or 16 bits, gray or colour, or an image with a VICAR, PDS3 or
/// PDS4 label of any samples (label_samples.h converts them to 16 bits; the depth is then that of
/// the label), with any name. Alpha is dropped; an orientation tag is not applied (calibration
/// belongs to the stored pixels). Rule: colour by luma (9798 R + 19235 G + 3735 B + 16384) >> 15 on
/// the samples, then floor(v * 255 / (2^n - 1) + 0.5) or the given table; a sample above 2^n - 1
/// contradicts the stated depth and is rejected. InputError when the file is missing, empty,
/// truncated, damaged, of another format, or too large.
GrayImage readImage(const std::filesystem::path& file, const ImageReadOptions& options = {});

/// The samples of an image before they become 8 bit, colour by the same luma: for display and for
/// choosing levels. The core does not use them.
struct ImageSamples {
  int width = 0;
  int height = 0;
  int sample_bits = 8;                ///< of the file: 8 or 16
  std::vector<std::uint16_t> values;  ///< row-major, width * height
  /// The file's own value is offset + scale * value; not 0 and 1 where fractional or negative
  /// numbers were converted to 16 bits.
  double offset = 0.0;
  double scale = 1.0;
  std::string file_sha256;
};

/// Reads the same files as readImage, with the same errors except for the depth.
ImageSamples readSamples(const std::filesystem::path& file,
                         const std::optional<BayerPattern>& bayer = {});

/// The 8-bit values of the samples 0 .. 2^n - 1 by levels with 0 <= black < white <= 2^n - 1, for
/// n from 1 to 16: floor((v - black) * 255 / (white - black) + 0.5), in integers.
std::vector<std::uint8_t> tableOfLevels(const GrayLevels& levels, int n);

/// InputError with both sizes when the image is not of the camera's size.
void requireSameSize(const GrayImage& image, const Camera& camera);

/// Pixels to ignore, packed as the core requires.
struct IgnoreMask {
  std::filesystem::path file;
  int width = 0;
  int height = 0;
  std::vector<std::uint64_t> words;
  std::int64_t ignored_count = 0;
  std::string file_sha256;

  /// The core takes masks as `const BitImage*`; do not write to a constant mask through this.
  BitImage view() const;
};

/// No pixel ignored.
IgnoreMask emptyMask(int width, int height);

/// Reads a mask image of width x height (PNG or TIFF): a pixel is ignored where any channel but
/// alpha is not zero. A JPEG is rejected, because its compression leaves stray nonzero pixels.
/// InputError.
IgnoreMask readIgnoreMask(const std::filesystem::path& file, int width, int height);

/// A PNG of 8-bit gray or BGR pixels (channels 1 or 3, row-major), written atomically; OutputError.
void writePng(const std::filesystem::path& file, std::span<const std::uint8_t> pixels, int width,
              int height, int channels);

}  // namespace boresight::sessions
