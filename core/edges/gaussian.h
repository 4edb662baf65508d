// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/edges/equalize.h"

namespace boresight {

inline constexpr int kMaxGaussianRadius = 24;  ///< at the largest sigma, 8 px

/// Symmetric integer kernel with w0 + 2 (w1 + ... + w_radius) = 256: OpenCV's for 8-bit images, of
/// radius about 3 sigma; the rounding error of each weight is carried on to the next inner one.
struct GaussianKernel {
  int radius = 0;                                              ///< px
  std::array<std::uint16_t, kMaxGaussianRadius + 2> weight{};  ///< from the centre; zero beyond
};

/// `sigma_px` in [0, 8]; 0 gives the identity.
GaussianKernel gaussianKernel(double sigma_px);

/// Separable Gaussian over rows that pass through: a ring of 2 radius + 1 equalized rows, mirrored
/// at the image border (reflect 101). Sums are exact, rounded once at the end to
/// (sum + 2^15) / 2^16, halves up, like cv::GaussianBlur on 8-bit images.
class SmoothedRows {
 public:
  /// Takes the ring from `arena`, for an image of this size.
  void begin(int width, int height, double sigma_px, Arena& arena);
  /// Restarts at the first row.
  void restart() { loaded_ = 0; }
  /// Writes row y to `out`: roundUpToBlock(width) bytes, unspecified from `width` on. Rows must be
  /// requested in ascending order.
  void row(int y, const Equalizer& source, std::uint8_t* out);

 private:
  std::uint8_t* slot(int y) { return ring_.data() + ring_stride_ * (y % ring_rows_); }
  void sumColumns(int y);
  void mirrorSides();

  GaussianKernel kernel_;
  int width_ = 0;
  int height_ = 0;
  int loaded_ = 0;  ///< rows that entered the ring
  int ring_rows_ = 1;
  std::ptrdiff_t ring_stride_ = 0;
  std::span<std::uint8_t> ring_;
  std::span<std::uint16_t> high_;  ///< upper bytes of the column sums, with a margin on both sides
  std::span<std::uint16_t> low_;   ///< lower bytes
};

}  // namespace boresight
