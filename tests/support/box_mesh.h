// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "sessions/io/meshes/scene_mesh.h"

namespace boresight::test {

/// Adds a quad of vertices, in order, as two triangles of the part 0.
inline void addQuad(sessions::SceneMesh& scene, std::int32_t a, std::int32_t b, std::int32_t c,
                    std::int32_t d) {
  scene.faces.push_back({{a, b, c}});
  scene.faces.push_back({{a, c, d}});
  scene.part_of_face.insert(scene.part_of_face.end(), 2, 0);
}

/// Corner `i` of 0 .. 7 of a box about the origin: bits 0, 1, 2 are the upper sides in x, y, z.
inline Eigen::Vector3d boxCorner(const Eigen::Vector3d& half_m, int i) {
  return half_m.cwiseProduct(Eigen::Vector3d((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1));
}

/// The corners of a box's sides, counterclockwise from outside.
inline constexpr int kBoxQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// A box about the origin as the first part of a scene.
inline sessions::SceneMesh boxMesh(const Eigen::Vector3d& half_m) {
  sessions::SceneMesh scene;
  scene.parts.resize(1);
  for (int i = 0; i < 8; ++i)
    scene.vertices_in_station_m.push_back(boxCorner(half_m, i).cast<float>());
  for (const auto& quad : kBoxQuads) addQuad(scene, quad[0], quad[1], quad[2], quad[3]);
  return scene;
}

}  // namespace boresight::test
