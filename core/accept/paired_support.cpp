// SPDX-License-Identifier: Apache-2.0
#include "core/accept/paired_support.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

/// Whether a render has an edge within `radius` px of a pixel along either axis.
bool hasEdgeNear(const EdgeRender& render, int x, int y, int radius) {
  const int x_end = std::min(render.edges.width - 1, x + radius);
  const int y_end = std::min(render.edges.height - 1, y + radius);
  for (int v = std::max(0, y - radius); v <= y_end; ++v) {
    for (int u = std::max(0, x - radius); u <= x_end; ++u)
      if (render.edges.get(u, v)) return true;
  }
  return false;
}

struct Counts {
  std::int32_t alone = 0, alone_covered = 0;
  std::int32_t common = 0, common_covered = 0;
  std::int32_t displaced = 0, displaced_covered = 0;
};

/// Edges between near and far of another pose's are left out: either may have been found there.
Counts countPredictions(const EdgeRender& one, const EdgeRender& other, int level,
                        const ImageView& image, const BitImage* ignore) {
  constexpr std::int32_t kMostPlaces = 6000;
  constexpr int kNear_px = 1;
  const int far_px = static_cast<int>(kSupportRadius_px) + 1;
  const EdgeSearch search(kSupportDerivativeSigma_px);
  const std::int32_t stride = std::max(1, (one.pixel_count + kMostPlaces - 1) / kMostPlaces);
  Counts made;
  int direction = 0;
  for (std::int32_t i = 0; i < one.pixel_count; i += stride) {
    const EdgePixel& pixel = one.pixels[static_cast<std::size_t>(i)];
    if (!hasEdgeNear(other, pixel.x, pixel.y, far_px)) {
      countEdge(pixel, -1, level, search, image, ignore, made.alone, made.alone_covered);
    } else if (hasEdgeNear(other, pixel.x, pixel.y, kNear_px)) {
      countEdge(pixel, -1, level, search, image, ignore, made.common, made.common_covered);
    }
    countEdge(pixel, direction, level, search, image, ignore, made.displaced,
              made.displaced_covered);
    direction = (direction + 1) % 4;
  }
  return made;
}

}  // namespace

double PairedSupport::nats() const {
  constexpr double kAlong = 8.0;   ///< edge pixels that go together
  constexpr double kLeast = 0.05;  ///< nothing is ever certain
  constexpr double kApart = 0.05;  ///< seen so much more often than by chance
  if (common == 0 || displaced == 0) return 0.0;
  const double chance =
      std::clamp(static_cast<double>(displaced_covered) / displaced, kLeast, 1.0 - kLeast);
  const double there =
      std::clamp(static_cast<double>(common_covered) / common, kLeast, 1.0 - kLeast);
  if (there < chance + kApart) return 0.0;
  const double seen = naturalLogarithm(there / chance);
  const double missing = naturalLogarithm((1.0 - there) / (1.0 - chance));
  const double own_nats = own_covered * seen + (own - own_covered) * missing;
  const double other_nats = other_covered * seen + (other - other_covered) * missing;
  return (own_nats - other_nats) / kAlong;
}

PairedSupport comparePredictions(const EdgeRender& own, const EdgeRender& other, int level,
                                 const ImageView& image, const BitImage* ignore) {
  const Counts one = countPredictions(own, other, level, image, ignore);
  const Counts two = countPredictions(other, own, level, image, ignore);
  PairedSupport made;
  made.own = one.alone;
  made.own_covered = one.alone_covered;
  made.other = two.alone;
  made.other_covered = two.alone_covered;
  made.common = one.common + two.common;
  made.common_covered = one.common_covered + two.common_covered;
  made.displaced = one.displaced + two.displaced;
  made.displaced_covered = one.displaced_covered + two.displaced_covered;
  return made;
}

void copyRender(const EdgeRender& from, EdgeRender& to) {
  const auto copyBits = [](const BitImage& bits, std::span<std::uint64_t> words, BitImage& made) {
    made = bits;
    made.words = words.first(bits.words.size());
    std::copy(bits.words.begin(), bits.words.end(), made.words.begin());
  };
  copyBits(from.edges, to.edge_words, to.edges);
  copyBits(from.mask, to.mask_words, to.mask);
  std::copy_n(from.pixels.begin(), from.pixel_count, to.pixels.begin());
  std::copy_n(from.row_begin.begin(), from.edges.height + 1, to.row_begin.begin());
  to.pixel_count = from.pixel_count;
  to.camera = from.camera;
  to.camera_from_station = from.camera_from_station;
}

}  // namespace boresight
