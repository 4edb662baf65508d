// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/match/pixel_words.h"
#include "core/match/whs_types.h"

namespace boresight {

inline constexpr int kMaxTemplateSide_px = 512;
inline constexpr int kMaxTemplateWords = kMaxTemplateSide_px / 64;

/// True when the view names two images and a square of even side, at most 512, inside both.
bool isValidTemplate(const TemplateView& view);

/// True when the template centred at (x, y) lies wholly inside `test_edges`.
bool templateFits(const TemplateView& view, const BitImage& test_edges, int x, int y);

/// 64 pixels from column 64 * word of row v (0 ... side - 1) of the template's mask, and of its
/// edges inside the mask; zero beyond its sides.
inline std::uint64_t maskWord(const TemplateView& view, int v, int word) {
  const int half = view.side_px / 2;
  return pixelsAt(*view.mask, view.center_x - half + 64 * word, view.center_y - half + v) &
         sideMask(view.side_px, word);
}
inline std::uint64_t edgeWord(const TemplateView& view, int v, int word) {
  const int half = view.side_px / 2;
  return pixelsAt(*view.edges, view.center_x - half + 64 * word, view.center_y - half + v) &
         maskWord(view, v, word);
}

}  // namespace boresight
