// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"
#include "sessions/io/meshes/mesh_file.h"

namespace boresight::test {

/// Sum over the faces of what `part` makes of their corners.
template <class Part>
inline double sumOver(const sessions::Mesh& mesh, Part&& part) {
  double sum = 0.0;
  for (const Face& face : mesh.faces) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return mesh.vertices_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
    };
    sum += part(corner(0), corner(1), corner(2));
  }
  return sum;
}

inline double signedVolume_m3(const sessions::Mesh& mesh) {
  using V = const Eigen::Vector3d&;
  return sumOver(mesh, [](V a, V b, V c) { return a.dot(b.cross(c)) / 6.0; });
}

inline double area_m2(const sessions::Mesh& mesh) {
  using V = const Eigen::Vector3d&;
  return sumOver(mesh, [](V a, V b, V c) { return 0.5 * (b - a).cross(c - a).norm(); });
}

inline Status validity(const sessions::Mesh& mesh) {
  const std::vector<std::uint16_t> part_of_face(mesh.faces.size(), 0);
  const std::array<ScenePart, 1> parts = {};
  return validateMesh({mesh.vertices_m, mesh.faces, part_of_face, parts});
}

/// A closed, outward cube whatever the format: 8 vertices, 12 faces, the right place and volume.
inline void expectCube(const sessions::Mesh& mesh, double scale = 1.0) {
  EXPECT_EQ(mesh.vertices_m.size(), 8u);
  EXPECT_EQ(mesh.faces.size(), 12u);
  EXPECT_TRUE(mesh.info.minimum_m.isApprox(scale * Eigen::Vector3d(-1, -1, 9), 1e-6));
  EXPECT_TRUE(mesh.info.maximum_m.isApprox(scale * Eigen::Vector3d(1, 1, 11), 1e-6));
  EXPECT_NEAR(signedVolume_m3(mesh) / std::pow(scale, 3), 8.0, 1e-5);
  EXPECT_NEAR(area_m2(mesh) / (scale * scale), 24.0, 1e-5);
  EXPECT_EQ(validity(mesh), Status::kOk);
}

}  // namespace boresight::test
