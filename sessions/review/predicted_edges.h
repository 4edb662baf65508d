// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// A piece of an edge that a pose predicts to be seen, in one pixel.
struct EdgePlace {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();   ///< on the line, sub-pixel
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the line, unit
  double length_px = 1.0;  ///< of the line that the pixel stands for: up to sqrt(2) on a diagonal
  std::uint8_t kind = 0;   ///< EdgeKind bits
};

/// The station's visible edges at full resolution, in raster order.
struct PredictedEdges {
  std::vector<EdgePlace> places;
  BitMap mask;  ///< the station's silhouette with its edges
};

/// Empty when the scene cannot be rendered from this pose. Throws std::bad_alloc.
PredictedEdges predictEdges(const Camera& camera, const MeshView& mesh,
                            const Pose& camera_from_station);

/// What moves a predicted place in the image.
struct PlaceDerivative {
  Eigen::Matrix<double, 2, 6> by_pose;    ///< px per left perturbation (rad, m), camera frame
  Eigen::Matrix<double, 2, 3> by_camera;  ///< px per px of focal length (fy with fx), cx, cy
};
/// False when the place does not project.
[[nodiscard]] bool placeDerivative(const Camera& camera, const Pose& camera_from_station,
                                   const Eigen::Vector3d& point_in_station_m,
                                   PlaceDerivative& derivative);

/// At most `most` places, evenly along the order in which they are.
std::vector<EdgePlace> thinned(const std::vector<EdgePlace>& places, std::size_t most);

}  // namespace boresight::sessions
