// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/render/ray_grid.h"

namespace boresight {

/// The mesh seen from one pose: its vertices in the camera frame, and their pixels, which serve
/// for bounds only. Refilled for every pose.
struct CameraScene {
  struct Pixel {
    float x = 0.0F;
    float y = 0.0F;  ///< kNotProjected when the vertex has no usable pixel
  };
  static constexpr float kNotProjected = 1e30F;

  MeshView mesh;
  MeshAdjacency adjacency;
  double near_plane_m = 0.0;
  std::span<Eigen::Vector3d> vertex_in_camera_m;
  std::span<Pixel> vertex_px;
  std::span<double> cos_normal_threshold;  ///< per part
  /// Per face: bit i when the surface goes on smoothly over edge i to a face oriented alike;
  /// kFrontFacing when the outer side is seen from this pose.
  std::span<std::uint8_t> face_flags;
  static constexpr std::uint8_t kFrontFacing = 8;

  /// The mesh and its adjacency must outlive the scene. What depends on the pose comes from
  /// `scratch`.
  static Status create(const MeshView& mesh, const MeshAdjacency& adjacency, double near_plane_m,
                       Arena& kept, Arena& scratch, CameraScene& scene);

  /// Vertices first .. last - 1 into the camera frame.
  void transform(const Pose& camera_from_station, const RayGrid& rays, std::size_t first,
                 std::size_t last);

  /// Sets a face's kFrontFacing.
  void orient(std::int32_t face);

  /// True when two faces share an edge over which the surface goes on smoothly, and show the same
  /// side: where they meet there is no edge to be found.
  bool continues(std::int32_t face, std::int32_t other) const {
    const auto& around = adjacency.neighbour[static_cast<std::size_t>(face)];
    const std::uint8_t flags = face_flags[static_cast<std::size_t>(face)];
    if (((flags ^ face_flags[static_cast<std::size_t>(other)]) & kFrontFacing) != 0) return false;
    return (around[0] == other && (flags & 1) != 0) || (around[1] == other && (flags & 2) != 0) ||
           (around[2] == other && (flags & 4) != 0);
  }

  const Eigen::Vector3d& vertex(std::int32_t face, int corner) const {
    const Face& indices = mesh.faces[static_cast<std::size_t>(face)];
    return vertex_in_camera_m[static_cast<std::size_t>(
        indices.vertex[static_cast<std::size_t>(corner)])];
  }
  const ScenePart& part(std::int32_t face) const { return mesh.parts[partIndex(face)]; }
  std::size_t partIndex(std::int32_t face) const {
    return mesh.part_of_face[static_cast<std::size_t>(face)];
  }

 private:
  Eigen::Vector3d outerNormal(std::size_t face) const;
  std::uint8_t smoothEdges(std::size_t face) const;
};

/// a x b, each component a difference of two products: cross(a, b) == -cross(b, a) bit for bit,
/// so that the two triangles at an edge see the same line.
inline Eigen::Vector3d crossProduct(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

inline double dotProduct(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

/// The three edges of a triangle seen from the camera centre: value e_i = edge[i] . ray is positive
/// on the triangle's side of edge i (vertex i to vertex (i + 1) % 3), for rays (x/z, y/z, 1)
/// (homogeneous rasterization: Olano & Greer, "Triangle Scan Conversion using 2D Homogeneous
/// Coordinates", 1997). False when the triangle has no area seen from the camera.
[[nodiscard]] bool faceEdges(const CameraScene& scene, std::int32_t face, Eigen::Vector3d edge[3]);

/// The plane of a face as 1/z = plane . ray; it points away from the camera, so -plane / |plane| is
/// the face's unit normal on the camera's side, and 1 / |plane| its distance in metres. False when
/// the face is degenerate or seen exactly edge-on.
[[nodiscard]] bool facePlane(const CameraScene& scene, std::int32_t face, Eigen::Vector3d& plane);

/// Pixels that a face can cover: a conservative rectangle, empty when it holds no pixel centre.
struct PixelBounds {
  int x_first = 0;
  int x_last = -1;
  int y_first = 0;
  int y_last = -1;
  bool empty() const { return x_last < x_first || y_last < y_first; }
};
PixelBounds faceBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face);

}  // namespace boresight
