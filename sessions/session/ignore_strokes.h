// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"
#include "sessions/io/image_file.h"

namespace boresight::sessions {

enum class StrokeKind {
  kBrush,       ///< pixels whose centre is within `radius_px` of the line through the points
  kPolygon,     ///< pixels whose centre is inside the points' polygon (even-odd)
  kSaturation,  ///< pixels of at least `level`
};

/// One edit of an ignore mask, as a person made it.
struct MaskStroke {
  StrokeKind kind = StrokeKind::kBrush;
  bool erase = false;                   ///< the pixels are trusted again
  double radius_px = 8.0;               ///< of a brush
  int level = 255;                      ///< of a saturation, 0 .. 255
  std::vector<Eigen::Vector2d> points;  ///< px; none for a saturation
  std::string name = {};                ///< for people, "gripper"; may be empty

  bool operator==(const MaskStroke&) const = default;
};

using MaskStrokes = std::vector<MaskStroke>;

/// No pixel ignored.
IgnoreMask emptyMask(int width, int height);

/// Applies strokes in their order to a mask of the image's size, and counts anew. Only + - * and
/// comparisons of doubles: the same pixels on every machine.
void applyStrokes(const MaskStrokes& strokes, const ImageView& image, IgnoreMask& mask);

}  // namespace boresight::sessions
