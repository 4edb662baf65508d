// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/patch_pictures.h"

namespace boresight::ui {
namespace {

bool bitAt(const BitImage& image, const PatchPlace& place, int u, int v) {
  const int x = place.center_x - place.side_px / 2 + u;
  const int y = place.center_y - place.side_px / 2 + v;
  return image.contains(x, y) && image.get(x, y);
}

/// color_of(u, v) for every pixel.
template <class ColorOf>
QImage drawn(int side_px, const ColorOf& color_of) {
  QImage picture(side_px, side_px, QImage::Format_RGB32);
  for (int v = 0; v < side_px; ++v) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(v));
    for (int u = 0; u < side_px; ++u) line[u] = color_of(u, v);
  }
  return picture;
}

}  // namespace

QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place) {
  return drawn(place.side_px, [&](int u, int v) {
    if (bitAt(edges, place, u, v)) return patch_colors::kEdge;
    return bitAt(mask, place, u, v) ? patch_colors::kMask : patch_colors::kGround;
  });
}

QImage seenPicture(const BitImage& test_edges, const PatchPlace& place) {
  return drawn(place.side_px, [&](int u, int v) {
    return bitAt(test_edges, place, u, v) ? patch_colors::kEdge : patch_colors::kGround;
  });
}

QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found) {
  return drawn(rendered.side_px, [&](int u, int v) {
    if (!bitAt(mask, rendered, u, v)) return patch_colors::kGround;
    const bool is_rendered = bitAt(edges, rendered, u, v);
    const bool is_seen = bitAt(test_edges, found, u, v);
    if (is_rendered && is_seen) return patch_colors::kEdge;
    if (is_rendered) return patch_colors::kOnlyRendered;
    return is_seen ? patch_colors::kOnlySeen : patch_colors::kMask;
  });
}

}  // namespace boresight::ui
