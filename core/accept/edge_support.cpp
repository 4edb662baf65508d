// SPDX-License-Identifier: Apache-2.0
#include "core/accept/edge_support.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr std::int32_t kMaxPlaces = 3000;  ///< enough for a share to within 1 %, in one slice

/// Displacements of the render that measure the share by chance, px of the render: beyond any
/// search radius in use, and not a multiple of a power of two, which a raster may have.
constexpr int kDisplacements[4][2] = {{11, 0}, {0, 11}, {-11, 0}, {0, -11}};

/// A pixel moved by kDisplacements[direction]; unmoved for direction -1.
EdgePixel displaced(EdgePixel pixel, int direction) {
  if (direction < 0) return pixel;
  pixel.x = static_cast<std::int16_t>(pixel.x + kDisplacements[direction][0]);
  pixel.y = static_cast<std::int16_t>(pixel.y + kDisplacements[direction][1]);
  return pixel;
}

void measureCoverage(const EdgeRender& render, int level, const ImageView& image,
                     const BitImage* ignore, EdgeSupport& support) {
  const EdgeSearch search(kSupportDerivativeSigma_px);
  int direction = 0;
  for (const EdgePixel& pixel : render.eachPixel(render.strideFor(kMaxPlaces))) {
    countEdge(pixel, -1, level, search, image, ignore, support.rendered, support.covered);
    countEdge(pixel, direction, level, search, image, ignore, support.displaced,
              support.displaced_covered);
    direction = (direction + 1) % 4;
  }
}

/// The 64 bits from pixel x on of a row; pixels outside the image are 0.
std::uint64_t bitsFrom(const BitImage& image, int x, int y) {
  if (y < 0 || y >= image.height) return 0;
  const std::uint64_t* row = image.row(y);
  const int word = x >= 0 ? x / 64 : -((63 - x) / 64);
  const int bit = x - 64 * word;
  const auto wordAt = [&](int w) {
    return w >= 0 && w < image.words_per_row ? row[w] : std::uint64_t{0};
  };
  return bit == 0 ? wordAt(word) : (wordAt(word) >> bit) | (wordAt(word + 1) << (64 - bit));
}

/// The same, dilated by one pixel in all directions.
std::uint64_t dilatedBitsFrom(const BitImage& image, int x, int y) {
  std::uint64_t bits = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) bits |= bitsFrom(image, x + dx, y + dy);
  }
  return bits;
}

void measureExplanation(const EdgeRender& render, const BitImage& test_edges,
                        EdgeSupport& support) {
  const int height = std::min(render.edges.height, test_edges.height);
  const int words = std::min(render.edges.words_per_row, test_edges.words_per_row);
  for (int y = 0; y < height; ++y) {
    for (int w = 0; w < words; ++w) {
      const std::uint64_t seen = test_edges.row(y)[w] & render.mask.row(y)[w];
      if (seen == 0) continue;
      support.seen += std::popcount(seen);
      support.explained += std::popcount(seen & dilatedBitsFrom(render.edges, 64 * w, y));
      for (const auto& displacement : kDisplacements) {
        const std::uint64_t moved =
            dilatedBitsFrom(render.edges, 64 * w - displacement[0], y - displacement[1]);
        support.displaced_explained += std::popcount(seen & moved);
      }
    }
  }
}

}  // namespace

void countEdge(const EdgePixel& pixel, int direction, int level, const EdgeSearch& search,
               const ImageView& image, const BitImage* ignore, std::int32_t& looked,
               std::int32_t& covered) {
  const double scale = levelScale(level);
  const Eigen::Vector2d place_px = atFullResolution(displaced(pixel, direction).onLine_px(), level);
  const int x = std::clamp(static_cast<int>(place_px.x() + 0.5), 0, image.width - 1);
  const int y = std::clamp(static_cast<int>(place_px.y() + 0.5), 0, image.height - 1);
  if (ignore != nullptr && ignore->get(x, y)) return;
  ++looked;
  const EdgePeak peak = search.find(image, ignore, place_px, pixel.normal(),
                                    kSupportRadius_px * scale, kSupportMinGradient);
  if (peak.gradient != 0.0 && std::abs(peak.offset_px) <= kSupportNear_px * scale) ++covered;
}

EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore) {
  EdgeSupport support;
  measureCoverage(render, level, image, ignore, support);
  measureExplanation(render, nth(edges.level, level), support);
  return support;
}

}  // namespace boresight
