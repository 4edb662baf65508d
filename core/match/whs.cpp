// SPDX-License-Identifier: Apache-2.0
#include "core/match/whs.h"

#include <cstddef>

#include "core/match/bit_rows.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

bool imageIsWhole(const BitImage* image) {
  return image != nullptr && image->width > 0 && image->height > 0 &&
         image->words_per_row >= BitImage::wordsPerRow(image->width) &&
         image->words.size() >= static_cast<std::size_t>(image->words_per_row) *
                                    static_cast<std::size_t>(image->height);
}

bool squareInside(const BitImage& image, int center_x, int center_y, int side) {
  const int half = side / 2;
  return center_x >= half && center_y >= half && center_x <= image.width - half &&
         center_y <= image.height - half;
}

}  // namespace

bool isValidTemplate(const TemplateView& view) {
  return imageIsWhole(view.edges) && imageIsWhole(view.mask) && view.side_px >= 2 &&
         view.side_px <= kMaxTemplateSide_px && view.side_px % 2 == 0 &&
         squareInside(*view.edges, view.center_x, view.center_y, view.side_px) &&
         squareInside(*view.mask, view.center_x, view.center_y, view.side_px);
}

bool templateFits(const TemplateView& view, const BitImage& test_edges, int x, int y) {
  return imageIsWhole(&test_edges) && squareInside(test_edges, x, y, view.side_px);
}

double whsScore(const WhsCounts& counts, const WhsNorms& norms) {
  const double edges =
      norms.edges > 0 ? static_cast<double>(counts.edge_hits) / static_cast<double>(norms.edges)
                      : 0.0;
  const double empties = norms.empties > 0 ? static_cast<double>(counts.empty_hits) /
                                                 static_cast<double>(norms.empties)
                                           : 0.0;
  return edges + empties;
}

WhsNorms whsNorms(const TemplateView& view) {
  WhsNorms norms;
  if (!isValidTemplate(view)) return norms;
  for (int v = 0; v < view.side_px; ++v) {
    for (int word = 0; 64 * word < view.side_px; ++word) {
      const std::uint64_t mask = maskWord(view, v, word);
      const std::uint64_t edges = edgeWord(view, v, word);
      norms.edges += countOnes(edges);
      norms.empties += countOnes(mask & ~edges);
    }
  }
  return norms;
}

WhsCounts whsCountsAt(const TemplateView& view, const BitImage& test_edges, int x, int y) {
  WhsCounts counts;
  if (!isValidTemplate(view) || !templateFits(view, test_edges, x, y)) return counts;
  const int half = view.side_px / 2;
  for (int v = 0; v < view.side_px; ++v) {
    for (int word = 0; 64 * word < view.side_px; ++word) {
      const std::uint64_t mask = maskWord(view, v, word);
      if (mask == 0) continue;
      const std::uint64_t edges = edgeWord(view, v, word);
      const std::uint64_t test = pixelsAt(test_edges, x - half + 64 * word, y - half + v);
      counts.edge_hits += countOnes(edges & test);
      counts.empty_hits += countOnes(mask & ~edges & ~test);
    }
  }
  return counts;
}

void whsScoreMap(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window,
                 std::span<WhsCounts> map) {
  if (window.empty()) return;
  std::size_t next = 0;
  for (int y = window.y_min; y <= window.y_max; ++y) {
    for (int x = window.x_min; x <= window.x_max && next < map.size(); ++x) {
      map[next++] = whsCountsAt(view, test_edges, x, y);
    }
  }
}

}  // namespace boresight
