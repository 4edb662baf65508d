// SPDX-License-Identifier: Apache-2.0
#include "core/match/whs.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/match/pixel_words.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

bool imageIsWhole(const BitImage* image) {
  return image != nullptr && image->words_per_row >= BitImage::wordsPerRow(image->width) &&
         image->words.size() >= static_cast<std::size_t>(image->words_per_row) *
                                    static_cast<std::size_t>(image->height);
}

bool squareInside(const BitImage& image, int center_x, int center_y, int side) {
  const int half = side / 2;
  return center_x >= half && center_y >= half && center_x <= image.width - half &&
         center_y <= image.height - half;
}

/// A place of the template's centre, and the counts there.
struct Place {
  int x = 0, y = 0;
  WhsCounts counts;
};

/// Counts at several places, at all of which the template lies inside, in one pass over it.
void countPlaces(const TemplateView& view, const BitImage& test_edges, std::span<Place> places) {
  const int half = view.side_px / 2;
  for (int v = 0; v < view.side_px; ++v) {
    for (int word = 0; 64 * word < view.side_px; ++word) {
      const std::uint64_t mask = maskWord(view, v, word);
      if (mask == 0) continue;
      const std::uint64_t edges = edgeWord(view, v, word);
      for (Place& place : places) {
        const std::uint64_t test =
            pixelsAt(test_edges, place.x - half + 64 * word, place.y - half + v);
        place.counts.edge_hits += countOnes(edges & test);
        place.counts.empty_hits += countOnes(mask & ~edges & ~test);
      }
    }
  }
}

/// Offset of the top of the parabola through (-1, left), (0, middle), (1, right), within +-0.5; 0
/// where it has no top.
double parabolaTop(std::int64_t left, std::int64_t middle, std::int64_t right) {
  const std::int64_t curvature = left - 2 * middle + right;
  if (curvature >= 0) return 0.0;
  const double top = 0.5 * static_cast<double>(left - right) / static_cast<double>(curvature);
  return std::clamp(top, -0.5, 0.5);
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
  if (!isValidTemplate(view) || !templateFits(view, test_edges, x, y)) return {};
  Place place{x, y, {}};
  countPlaces(view, test_edges, std::span(&place, 1));
  return place.counts;
}

void subpixelPeak(const TemplateView& view, const BitImage& test_edges, const WhsPeak& peak,
                  double& x, double& y) {
  x = peak.x;
  y = peak.y;
  if (!isValidTemplate(view) || !templateFits(view, test_edges, peak.x, peak.y)) return;
  enum { kMiddle, kLeft, kRight, kAbove, kBelow };
  std::array<Place, 5> places = {{{peak.x, peak.y, {}},
                                  {peak.x - 1, peak.y, {}},
                                  {peak.x + 1, peak.y, {}},
                                  {peak.x, peak.y - 1, {}},
                                  {peak.x, peak.y + 1, {}}}};
  const auto fits = [&](const Place& place) {
    return templateFits(view, test_edges, place.x, place.y);
  };
  const bool along_x = fits(places[kLeft]) && fits(places[kRight]);
  const bool along_y = fits(places[kAbove]) && fits(places[kBelow]);
  // The count at a place outside the image is not used: the peak's own count replaces it.
  for (Place& place : places) {
    if (!fits(place)) place = places[kMiddle];
  }
  countPlaces(view, test_edges, places);
  const WhsNorms norms = whsNorms(view);
  const auto top = [&](const Place& before, const Place& after) {
    return parabolaTop(whsComparable(before.counts, norms),
                       whsComparable(places[kMiddle].counts, norms),
                       whsComparable(after.counts, norms));
  };
  if (along_x) x += top(places[kLeft], places[kRight]);
  if (along_y) y += top(places[kAbove], places[kBelow]);
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
