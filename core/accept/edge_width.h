// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "core/base/image.h"
#include "core/edges/directed_edges.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Width of the image's edges at the edges of a pose. Motion and defocus widen the edges and make
/// the pose error larger than its covariance states. The width of an edge is the height of its ramp
/// over the steepest slope.
struct EdgeWidth {
  /// Widest edges of an accepted pose. Sharp images have 2 to 7 px; those blurred by 16 px have 13
  /// to 17 px, and 7 of 20 rendered stations then missed the requirement.
  static constexpr double kWidest_px = 10.0;

  std::array<double, kEdgeDirections> width_px{};      ///< median by direction of the normal
  std::array<std::int32_t, kEdgeDirections> places{};  ///< number of places of each median

  /// Direction with the widest edges among those with enough places; -1: too few are seen.
  int widestDirection() const;
  /// Width in the widest direction; 0 when too few edges are seen.
  double widest_px() const;
  /// Whether the image is sharp enough for a pose.
  bool isSharp() const { return widest_px() <= kWidest_px; }
};

/// Collects the widths of an image's edges.
class EdgeWidthMeter {
 public:
  /// `image` is raw, at full resolution; `ignore` may be nullptr.
  EdgeWidthMeter(const ImageView& image, const BitImage* ignore) : image_(image), ignore_(ignore) {}
  /// Measures at a place of an edge, px of the image; `normal` has unit length.
  void add(const Eigen::Vector2d& place_px, const Eigen::Vector2d& normal);
  /// The widths at the places so far.
  EdgeWidth width() const;

 private:
  static constexpr int kBins = 128;
  static constexpr double kBin_px = 0.25;
  using Histogram = std::array<std::int32_t, kBins>;

  ImageView image_;
  const BitImage* ignore_;
  std::array<Histogram, kEdgeDirections> histograms_{};
};

/// `image` is raw, at full resolution; `level` is the render's. `ignore` may be nullptr.
EdgeWidth measureEdgeWidth(const EdgeRender& render, int level, const ImageView& image,
                           const BitImage* ignore);

}  // namespace boresight
