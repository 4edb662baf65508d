// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/edge_support.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

/// Gradient of the raw image over a step of `reach` pixels, averaged along the other axis (Sobel's
/// weights).
bool gradientAt(const ImageView& image, int x, int y, int reach, double& gx, double& gy) {
  if (x < reach || y < reach || x + reach >= image.width || y + reach >= image.height) return false;
  const std::uint8_t* above = image.row(y - reach);
  const std::uint8_t* middle = image.row(y);
  const std::uint8_t* below = image.row(y + reach);
  const int left = x - reach;
  const int right = x + reach;
  gx = above[right] - above[left] + 2 * (middle[right] - middle[left]) + below[right] - below[left];
  gy = below[left] - above[left] + 2 * (below[x] - above[x]) + below[right] - above[right];
  return true;
}

/// True when a test edge pixel of the level's 2^level block has a gradient along the rendered
/// normal.
bool blockSupports(const EdgePixel& pixel, int x, int y, int level, const EdgeMap& edges,
                   const ImageView& image, double min_cosine) {
  const int scale = 1 << level;
  const BitImage& full = edges.level[0];
  const int x_end = std::min(full.width, (x + 1) * scale);
  const int y_end = std::min(full.height, (y + 1) * scale);
  for (int v = y * scale; v < y_end; ++v) {
    for (int u = x * scale; u < x_end; ++u) {
      if (!full.get(u, v)) continue;
      double gx = 0.0;
      double gy = 0.0;
      if (!gradientAt(image, u, v, 2, gx, gy)) continue;
      const double along = gx * pixel.normal_x + gy * pixel.normal_y;
      const double length2 = (gx * gx + gy * gy) * (127.0 * 127.0);
      if (length2 > 0.0 && along * along >= min_cosine * min_cosine * length2) return true;
    }
  }
  return false;
}

bool isSupported(const EdgePixel& pixel, int level, const EdgeMap& edges, const ImageView& image,
                 double min_cosine) {
  constexpr int kOffsets[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const BitImage& map = edges.level[static_cast<std::size_t>(level)];
  for (const auto& offset : kOffsets) {
    const int x = pixel.x + offset[0];
    const int y = pixel.y + offset[1];
    if (!map.contains(x, y) || !map.get(x, y)) continue;
    if (blockSupports(pixel, x, y, level, edges, image, min_cosine)) return true;
  }
  return false;
}

}  // namespace

EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore,
                               const SupportOptions& options) {
  EdgeSupport support;
  const double min_cosine = cosine(options.direction_tolerance_rad);
  const int scale = 1 << level;
  for (std::int32_t i = 0; i < render.pixel_count; ++i) {
    const EdgePixel& pixel = render.pixels[static_cast<std::size_t>(i)];
    const int x = std::min(image.width - 1, pixel.x * scale + scale / 2);
    const int y = std::min(image.height - 1, pixel.y * scale + scale / 2);
    if (ignore != nullptr && ignore->get(x, y)) continue;
    ++support.rendered;
    if (isSupported(pixel, level, edges, image, min_cosine)) ++support.supported;
  }
  return support;
}

}  // namespace boresight
