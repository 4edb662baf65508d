// SPDX-License-Identifier: Apache-2.0
// Pictures of a template and of the place where it was found, one pixel per pixel of the level.
#pragma once

#include <QColor>
#include <QImage>

#include "core/base/image.h"

namespace boresight::ui {

/// A square of `side` pixels about a centre: centre - side/2 ... centre + side/2 - 1.
struct PatchPlace {
  int center_x = 0;
  int center_y = 0;
  int side_px = 0;
};

/// Fixed, on a dark ground whatever the palette: they differ in lightness as well as in colour.
namespace patch_colors {
inline constexpr QRgb kGround = qRgb(24, 24, 28);
inline constexpr QRgb kMask = qRgb(74, 74, 86);
inline constexpr QRgb kEdge = qRgb(255, 255, 255);
inline constexpr QRgb kOnlyRendered = qRgb(240, 140, 20);
inline constexpr QRgb kOnlySeen = qRgb(70, 150, 255);
}  // namespace patch_colors

/// Rendered edges over the mask.
QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place);
/// Edges of the image; what lies outside it is ground.
QImage seenPicture(const BitImage& test_edges, const PatchPlace& place);
/// The template laid over where it was found: edges of both, of the render alone, and of the image
/// alone (inside the mask, where they count).
QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found);

}  // namespace boresight::ui
