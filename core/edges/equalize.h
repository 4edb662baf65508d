// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/edges/edge_options.h"

namespace boresight {

inline constexpr int kGrayLevels = 256;
using GrayHistogram = std::array<std::int32_t, kGrayLevels>;  ///< pixels per gray level
using GrayTable = std::array<std::uint8_t, kGrayLevels>;      ///< gray level in -> gray level out

/// Table of the global equalization: out(v) = round(255 * (N(<= v) - N(v0)) / (N - N(v0))), v0 the
/// darkest level that occurs; single precision, halves to even, exactly as cv::equalizeHist. If
/// only one level occurs, all levels map to it; an empty histogram gives the identity.
GrayTable equalizeLut(const GrayHistogram& histogram);

/// Table of one tile of the contrast-limited adaptive equalization, exactly as cv::CLAHE: counts
/// above kClipLimit * N / 256 are cut off and spread over all levels, then out(v) = round(255 / N *
/// N(<= v)). The identity where the histogram is empty.
GrayTable claheLut(const GrayHistogram& histogram);

/// Equalization as a table that is applied while rows are read: the equalized image is never held.
/// Off, one table for the image, or CLAHE's tables per tile with bilinear interpolation between
/// tile centres. Ignored pixels do not count in any histogram, but are mapped like the others.
class Equalizer {
 public:
  static constexpr double kClipLimit = 2.0;  ///< of CLAHE; higher values amplify sensor noise
  static constexpr int kTiles = 8;           ///< of CLAHE along each axis, OpenCV's default

  /// Takes the tables from `arena`. `image` (pixels) and `ignore` (or nullptr) must outlive the
  /// equalizer.
  void begin(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
             Arena& arena);
  /// Counts about `pixel_budget` pixels; true when the tables are complete.
  [[nodiscard]] bool step(std::int32_t pixel_budget);
  /// Row y, equalized, into `out` (width bytes). The tables must be complete.
  void row(int y, std::uint8_t* out) const;

  /// px, of the image.
  int width() const { return image_.width; }
  /// px, of the image.
  int height() const { return image_.height; }

 private:
  static constexpr int kLanes = 4;  ///< neighbouring pixels count in different copies

  bool stepGlobal(std::int32_t pixel_budget);
  bool stepTiles(std::int32_t pixel_budget);
  void beginTiles(Arena& arena);
  void placeColumns();
  void countRow(int source_y, int first_x, int last_x);
  void countReflected(int source_y, int first_x, int last_x);
  GrayHistogram takeHistogram();
  void rowByTiles(int y, std::uint8_t* out) const;

  ImageView image_;
  const BitImage* ignore_ = nullptr;
  Equalization equalization_ = Equalization::kOff;
  int tiles_ = 1;  ///< along each axis
  int tile_width_ = 1;
  int tile_height_ = 1;
  int tile_ = 0;  ///< being counted
  int row_ = 0;   ///< next row to count, of the image or of the tile
  std::span<std::int32_t> counts_;
  std::span<std::uint8_t> tables_;      ///< tile after tile, row-major
  std::span<std::int32_t> left_table_;  ///< per column: where the left tile's table begins
  std::span<std::int32_t> right_table_;
  std::span<float> right_weight_;
};

}  // namespace boresight
