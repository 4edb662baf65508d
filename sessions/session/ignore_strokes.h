// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"
#include "sessions/io/images/image_file.h"

namespace boresight::sessions {

struct Session;
struct SessionCase;

enum class StrokeKind {
  kBrush,       ///< pixels whose centre is within `radius_px` of the line through the points
  kPolygon,     ///< pixels whose centre is inside the points' polygon (even-odd)
  kSaturation,  ///< pixels of at least `level`
};

/// One edit of an ignore mask, as the operator made it.
struct MaskStroke {
  StrokeKind kind = StrokeKind::kBrush;
  bool erase = false;                   ///< the pixels are no longer ignored
  double radius_px = 8.0;               ///< of a brush
  int level = 255;                      ///< of a saturation, 0 .. 255
  std::vector<Eigen::Vector2d> points;  ///< px; none for a saturation
  std::string name = {};                ///< for display, "gripper"; may be empty

  bool operator==(const MaskStroke&) const = default;
};

using MaskStrokes = std::vector<MaskStroke>;

/// Applies strokes in their order to a mask of the image's size, and counts again. Only + - * and
/// comparisons of doubles: the same pixels on every machine.
void applyStrokes(const MaskStrokes& strokes, const ImageView& image, IgnoreMask& mask);

/// The case with these strokes in place of its own; unchanged when there is no such case.
Session withStrokes(const Session& session, const std::string& case_id, MaskStrokes strokes);
/// Appends a stroke.
Session withStroke(const Session& session, const std::string& case_id, MaskStroke stroke);

/// Strokes that leave no pixel ignored: none or, where the case has a mask image, one stroke that
/// erases all of it.
MaskStrokes clearedStrokes(const SessionCase& session_case);

/// Other cases with an equal camera and image size.
std::vector<std::string> casesOfSameCamera(const Session& session, const std::string& case_id);
/// A stroke of one case added to all others of its camera that do not have it yet.
Session copyingStroke(const Session& session, const std::string& case_id, std::size_t stroke);
/// Strokes with a name of other cases of the same camera that this case does not have, each once.
MaskStrokes namedStrokesOfCamera(const Session& session, const std::string& case_id);

/// "brush, 12 px wide", "gripper (polygon of 5 corners)", "erase: pixels of at least 250".
std::string strokeText(const MaskStroke& stroke);

}  // namespace boresight::sessions
