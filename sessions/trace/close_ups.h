// SPDX-License-Identifier: Apache-2.0
// Image patches for a close comparison of the model's edges with the image's.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A patch of the image where edges of the pose run in several directions.
struct CloseUp {
  std::string name;  ///< "upper left": which quarter of the rendered edges
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  /// Between rendered and seen edge, along the normal: median over the places within the patch.
  double distance_px = 0.0;
  double found_share = 0.0;  ///< share of the places within the patch with an edge found
};

/// The best place of each quarter of the edges that a refinement used, in reading order; none of a
/// quarter where no edge of the image was found. `side_px` is the side of the square to be shown.
/// Best is where the smaller eigenvalue of the normals' scatter is largest (the measure of Shi and
/// Tomasi 1994): a corner shows a shift in any direction, a straight edge only across.
std::vector<CloseUp> closeUps(const Camera& camera, const RefinementTrace& refinement,
                              double side_px);

}  // namespace boresight::sessions
