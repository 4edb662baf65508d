// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A connected line of salient edges, in pixels of the full image.
struct EdgeLine {
  std::vector<Eigen::Vector2d> places_px;  ///< at least two
  Eigen::AlignedBox2d box_px;
};
using EdgeLines = std::vector<EdgeLine>;

/// Edge pixels of a render joined to lines at their sub-pixel places. Each edge pixel lies within a
/// pixel of a line; ends that meet are extended to the corner. `level` is that of the render.
EdgeLines edgeLines(const RenderTrace& render, int level);

/// Approximate length in pixels of the lines in a box.
double lengthWithin(const EdgeLines& lines, const Eigen::AlignedBox2d& box_px);

}  // namespace boresight::sessions
