// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/edge_support.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace boresight {
namespace {

constexpr std::int32_t kMaxPlaces =
    6000;  ///< so many tell the share to half a percent, in one slice

void measureCoverage(const EdgeRender& render, int level, const ImageView& image,
                     const BitImage* ignore, const SupportOptions& options, EdgeSupport& support) {
  const EdgeSearch search(options.derivative_sigma_px);
  const double scale = static_cast<double>(1 << level);
  const std::int32_t stride = std::max(1, (render.pixel_count + kMaxPlaces - 1) / kMaxPlaces);
  for (std::int32_t i = 0; i < render.pixel_count; i += stride) {
    const EdgePixel& pixel = render.pixels[static_cast<std::size_t>(i)];
    const Eigen::Vector2d normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y) / 127.0;
    const Eigen::Vector2d line = Eigen::Vector2d(pixel.x, pixel.y) + 0.01 * pixel.offset * normal;
    const Eigen::Vector2d place =
        (line.array() + 0.5).matrix() * scale - Eigen::Vector2d::Constant(0.5);
    const int x = std::clamp(static_cast<int>(place.x() + 0.5), 0, image.width - 1);
    const int y = std::clamp(static_cast<int>(place.y() + 0.5), 0, image.height - 1);
    if (ignore != nullptr && ignore->get(x, y)) continue;
    ++support.rendered;
    const EdgePeak peak = search.find(image, ignore, place, normal,
                                      options.search_radius_px * scale, options.min_gradient);
    if (peak.gradient != 0.0 && std::abs(peak.offset_px) <= options.near_px * scale)
      ++support.covered;
  }
}

/// Word `w` of a row, moved by one pixel to either side and kept: horizontal dilation by one pixel.
std::uint64_t dilatedWord(const BitImage& image, int y, int w) {
  if (y < 0 || y >= image.height) return 0;
  const std::uint64_t* row = image.row(y);
  const std::uint64_t before = w > 0 ? row[w - 1] >> 63 : 0;
  const std::uint64_t after = w + 1 < image.words_per_row ? row[w + 1] << 63 : 0;
  return row[w] | (row[w] << 1) | (row[w] >> 1) | before | after;
}

void measureExplanation(const EdgeRender& render, const BitImage& test_edges,
                        EdgeSupport& support) {
  const int height = std::min(render.edges.height, test_edges.height);
  const int words = std::min(render.edges.words_per_row, test_edges.words_per_row);
  for (int y = 0; y < height; ++y) {
    for (int w = 0; w < words; ++w) {
      const std::uint64_t seen = test_edges.row(y)[w] & render.mask.row(y)[w];
      if (seen == 0) continue;
      const std::uint64_t near = dilatedWord(render.edges, y - 1, w) |
                                 dilatedWord(render.edges, y, w) |
                                 dilatedWord(render.edges, y + 1, w);
      support.seen += std::popcount(seen);
      support.explained += std::popcount(seen & near);
    }
  }
}

}  // namespace

EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore,
                               const SupportOptions& options) {
  EdgeSupport support;
  measureCoverage(render, level, image, ignore, options, support);
  measureExplanation(render, edges.level[static_cast<std::size_t>(level)], support);
  return support;
}

}  // namespace boresight
