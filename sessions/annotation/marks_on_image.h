// SPDX-License-Identifier: Apache-2.0
// Where a pose puts marks on the image.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/annotation/marked_view.h"

namespace boresight::sessions {

/// An edge as the camera bends it: places along it, in order, from start to end; those that do not
/// project are left out. `pieces` >= 1.
std::vector<Eigen::Vector2d> edgeOnImage(const Camera& camera, const Pose& camera_from_station,
                                         const ModelEdge& edge, int pieces = 16);

/// What a pose leaves of a mark, as a vector on the image.
struct MarkVector {
  std::string id;
  Eigen::Vector2d predicted =
      Eigen::Vector2d::Zero();  ///< where the pose puts the point; of a
                                ///< line's end the nearest place of the edge
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
};

/// Of every complete mark that projects, also those that are off; a line has one for each end.
std::vector<MarkVector> markVectors(const MarkedView& view, const Pose& camera_from_station);

}  // namespace boresight::sessions
