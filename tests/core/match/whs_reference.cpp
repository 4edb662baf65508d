// SPDX-License-Identifier: Apache-2.0
#include "tests/core/match/whs_reference.h"

#include <cstdint>

namespace boresight {
namespace {

std::int64_t squaredDistance(int x, int y, int from_x, int from_y) {
  const std::int64_t dx = std::int64_t{x} - from_x;
  const std::int64_t dy = std::int64_t{y} - from_y;
  return dx * dx + dy * dy;
}

/// Does the 8x8 block of offsets that holds (x, y) touch the square around the best?
bool blockTouches(const SearchWindow& window, int x, int y, const WhsPeak& best, int exclusion_px) {
  const int block_x = window.x_min + (x - window.x_min) / 8 * 8;
  const int block_y = window.y_min + (y - window.y_min) / 8 * 8;
  return block_x <= best.x + exclusion_px && block_x + 7 >= best.x - exclusion_px &&
         block_y <= best.y + exclusion_px && block_y + 7 >= best.y - exclusion_px;
}

}  // namespace

WhsCounts whsCountsReference(const TemplateView& view, const BitImage& test_edges, int x, int y) {
  WhsCounts counts;
  const int half = view.side_px / 2;
  for (int v = -half; v < half; ++v) {
    for (int u = -half; u < half; ++u) {
      if (!view.mask->get(view.center_x + u, view.center_y + v)) continue;
      const bool edge = view.edges->get(view.center_x + u, view.center_y + v);
      const bool test = test_edges.get(x + u, y + v);
      if (edge && test) ++counts.edge_hits;
      if (!edge && !test) ++counts.empty_hits;
    }
  }
  return counts;
}

WhsNorms whsNormsReference(const TemplateView& view) {
  WhsNorms norms;
  const int half = view.side_px / 2;
  for (int v = -half; v < half; ++v) {
    for (int u = -half; u < half; ++u) {
      if (!view.mask->get(view.center_x + u, view.center_y + v)) continue;
      if (view.edges->get(view.center_x + u, view.center_y + v)) {
        ++norms.edges;
      } else {
        ++norms.empties;
      }
    }
  }
  return norms;
}

WhsPeak whsPeakReference(const TemplateView& view, const BitImage& test_edges,
                         const SearchWindow& window, int predicted_x, int predicted_y,
                         int exclusion_px) {
  const WhsNorms norms = whsNormsReference(view);
  WhsPeak peak;
  std::int64_t best = -1, best_distance = 0, second = -1, second_distance = 0;
  for (int y = window.y_min; y <= window.y_max; ++y) {
    for (int x = window.x_min; x <= window.x_max; ++x) {
      const WhsCounts counts = whsCountsReference(view, test_edges, x, y);
      const std::int64_t value = whsComparable(counts, norms);
      const std::int64_t distance = squaredDistance(x, y, predicted_x, predicted_y);
      if (value < best || (value == best && distance >= best_distance)) continue;
      best = value;
      best_distance = distance;
      peak.x = x;
      peak.y = y;
      peak.counts = counts;
    }
  }
  for (int y = window.y_min; y <= window.y_max; ++y) {
    for (int x = window.x_min; x <= window.x_max; ++x) {
      if (blockTouches(window, x, y, peak, exclusion_px)) continue;
      const WhsCounts counts = whsCountsReference(view, test_edges, x, y);
      const std::int64_t value = whsComparable(counts, norms);
      const std::int64_t distance = squaredDistance(x, y, predicted_x, predicted_y);
      if (value < second || (value == second && distance >= second_distance)) continue;
      second = value;
      second_distance = distance;
      peak.second_x = x;
      peak.second_y = y;
      peak.second_counts = counts;
      peak.has_second = true;
    }
  }
  return peak;
}

}  // namespace boresight
