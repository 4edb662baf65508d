// SPDX-License-Identifier: Apache-2.0
// A station to look at, and pictures of it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace example {

/// A mesh that owns what the core's view of it points to. Station frame, metres.
struct Station {
  std::vector<Eigen::Vector3f> vertices_in_station_m;
  std::vector<boresight::Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<boresight::ScenePart> parts{boresight::ScenePart()};

  boresight::MeshView view() const { return {vertices_in_station_m, faces, part_of_face, parts}; }
  void addBox(const Eigen::Vector3d& minimum_m, const Eigen::Vector3d& maximum_m);
};

/// A plate of 16 x 13 cm with five boxes of different sizes; nothing about it is symmetric.
/// z points out of the plate.
Station makeStation();

/// What the camera sees, row by row, 8 bits a pixel: four rays each, cast at every triangle and
/// shaded by a lamp at the side.
std::vector<std::uint8_t> photograph(const Station& station, const boresight::Camera& camera,
                                     const boresight::Pose& camera_from_station);

}  // namespace example
