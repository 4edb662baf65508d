// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/edges/equalize.h"
#include "core/edges/gaussian.h"

namespace boresight {

/// Sobel derivatives and gradient magnitude of the smoothed image, row after row, in a ring of
/// three rows, the input of non-maximum suppression. Derivatives are those of cv::Sobel with a 3 x
/// 3 kernel and replicated border. The magnitude is dx^2 + dy^2; it is 0 outside the image.
class GradientRows {
 public:
  /// Takes the ring from `arena`, for an image of this size.
  void begin(int width, int height, Arena& arena);
  /// Restarts before the first row.
  void restart();
  /// The next row, from rows of `smoothed` over `source`.
  void advance(const Equalizer& source, SmoothedRows& smoothed);
  /// Number of rows done by advance().
  int rowsDone() const { return rows_done_; }

  /// Magnitudes of row y: one of the last three rows done, or a row outside the image (zeros); x in
  /// [-1, width].
  const std::int32_t* magnitude(int y) const;
  /// Derivative to the right, for the same rows.
  const std::int16_t* dx(int y) const { return dx_.data() + columns_ * (y % kRing); }
  /// Derivative downwards, for the same rows.
  const std::int16_t* dy(int y) const { return dy_.data() + columns_ * (y % kRing); }

 private:
  static constexpr int kRing = 3;
  static constexpr int kAperture_px = 3;  ///< of Sobel; the preceding Gaussian sets the scale
  static constexpr std::ptrdiff_t kMargin =
      16;  ///< on both sides, so that blocks may reach over the border

  std::uint8_t* smoothedRow(int y) {
    return smoothed_.data() + (columns_ + 2 * kMargin) * (y % kAperture_px) + kMargin;
  }

  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t columns_ = 0;
  int rows_done_ = 0;
  int smoothed_done_ = 0;
  std::span<std::uint8_t> smoothed_;
  std::span<std::int16_t> dx_;
  std::span<std::int16_t> dy_;
  std::span<std::int32_t> magnitude_;  ///< the ring, then a row of zeros
};

/// Counts the magnitudes of unignored pixels and finds a quantile. Uses integers only. A pixel
/// counts as ceil(sqrt(magnitude)): `quantile(q)` is the smallest integer threshold h that at least
/// the share q of the pixels does not exceed.
class GradientHistogram {
 public:
  /// Takes the counters from `arena`.
  void begin(Arena& arena);
  /// Counts a row of GradientRows::magnitude; `ignored` is nullptr or a row of the ignore mask.
  void addRow(const std::int32_t* magnitude, const std::uint64_t* ignored, int width);
  /// The quantile `share`; the largest possible magnitude when no pixel was counted.
  std::int32_t quantile(double share) const;

 private:
  static constexpr int kLanes = 4;  ///< neighbouring pixels count in different copies

  std::ptrdiff_t bins_ = 0;
  std::span<std::int32_t> counts_;
};

}  // namespace boresight
