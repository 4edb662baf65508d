// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"

namespace boresight::sessions {

/// A part of an image; bounds belong to it.
struct ImageRegion {
  int x_min = 0, y_min = 0, x_max = -1, y_max = -1;

  int width() const { return x_max - x_min + 1; }
  int height() const { return y_max - y_min + 1; }
  bool empty() const { return width() <= 0 || height() <= 0; }
  bool contains(int x, int y) const { return x >= x_min && x <= x_max && y >= y_min && y <= y_max; }
};

/// What the raw image shows across a predicted line.
struct FoundEdge {
  double offset_px = 0.0;  ///< along the normal, from the predicted place
  double slope = 0.0;      ///< size of the derivative there, gray/px
};

/// The raw image's gradient, at a scale of its own (OpenCV's Gaussian and Scharr; the localization
/// has its own filters), and what can be asked of it: whether an edge of a given direction runs
/// through a place, and all edges of a region.
class ImageEdges {
 public:
  /// Gradients of a region, which is cut to the image; ignored pixels (`ignore` may be nullptr)
  /// show no edge. The image must outlive nothing: all that is needed is copied.
  ImageEdges(const ImageView& image, const BitImage* ignore, const ImageRegion& region);

  const ImageRegion& region() const { return region_; }
  bool isIgnored(int x, int y) const { return ignored_[indexOf(x, y)] != 0; }
  /// Gray per px; the pixel must lie in the region.
  Eigen::Vector2d gradient(int x, int y) const {
    return {static_cast<double>(dx_[indexOf(x, y)]), static_cast<double>(dy_[indexOf(x, y)])};
  }

  /// The steepest place along a line's normal within the radius whose gradient points along the
  /// normal, either way, to 25 deg; to a fraction of a pixel by a parabola. Nothing when there is
  /// none of `least_slope` (gray/px), or the profile leaves the region or meets ignored pixels.
  std::optional<FoundEdge> across(const Eigen::Vector2d& predicted_px,
                                  const Eigen::Vector2d& normal, double radius_px,
                                  double least_slope) const;
  /// Whether `across` can look there at all.
  bool canLook(const Eigen::Vector2d& predicted_px, double radius_px) const;

  /// Thin edges of the region (Canny 1986 with hysteresis down to half the slope): one byte a
  /// pixel, row by row of the region, not zero on an edge.
  std::vector<std::uint8_t> thinEdges(double least_slope) const;

 private:
  std::size_t indexOf(int x, int y) const {
    return static_cast<std::size_t>(y - region_.y_min) * static_cast<std::size_t>(region_.width()) +
           static_cast<std::size_t>(x - region_.x_min);
  }
  Eigen::Vector2d between(const Eigen::Vector2d& pixel) const;

  ImageRegion region_;
  std::vector<float> dx_;  ///< gray/px
  std::vector<float> dy_;
  std::vector<std::uint8_t> ignored_;
};

}  // namespace boresight::sessions
