// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/status.h"

namespace boresight {

/// One triangle: indices of its vertices, counter-clockwise seen from outside (back faces are
/// rendered all the same: coarse meshes are not always oriented).
struct Face {
  std::array<std::int32_t, 3> vertex{};  ///< indices into MeshView::vertices_in_station_m
};

/// Thresholds and role of one part of the scene.
struct ScenePart {
  double normal_threshold_rad = 0.5235987755982988;  ///< 30 deg
  /// Surfaces this much apart in depth have an edge between them.
  double depth_threshold_m = 0.005;
  bool match = true;  ///< false: occludes, yields neither edges nor mask nor templates
  /// The part does not move with the station: its vertices are in the camera frame. Never matched.
  bool fixed_to_camera = false;

  bool operator==(const ScenePart&) const = default;
};

/// A part's role as one byte of hashes and files: 0 occludes, 1 matched, 2 fixed to the camera.
constexpr std::uint8_t roleByte(const ScenePart& part) {
  if (part.fixed_to_camera) return 2;
  return part.match ? 1 : 0;
}

/// The scene, owned by the caller: welded vertices in the station frame (metres), faces, and the
/// part of each face. Single precision is 3e-8 m at 0.5 m, far below any edge's accuracy.
struct MeshView {
  /// Metres. The vertices of parts fixed to the camera come last, and are in the camera frame.
  std::span<const Eigen::Vector3f> vertices_in_station_m;
  std::span<const Face> faces;                             ///< triangles
  std::span<const std::uint16_t> part_of_face;             ///< index into parts, one per face
  std::span<const ScenePart> parts;                        ///< at least one
};

/// kInvalidMesh when there are no faces, an index is out of range, a coordinate or threshold is not
/// finite (or a threshold negative), the part of a face does not exist, or a part fixed to the
/// camera is matched or has vertices before those of another part. Degenerate faces (zero area) are
/// allowed and never rendered.
Status validateMesh(const MeshView& mesh);

/// Index of the first vertex in the camera frame: the least of the parts fixed to the camera; the
/// number of vertices where there are none.
std::size_t firstVertexInCamera(const MeshView& mesh);

/// Per face the face on the other side of edge i (vertex i to vertex (i + 1) % 3), or -1 at a
/// border or where more than two faces meet. Faces with a repeated vertex have no neighbours.
struct MeshAdjacency {
  std::span<std::array<std::int32_t, 3>> neighbour;  ///< one entry per face
};

/// Builds the adjacency; deterministic, O(n log n). The output comes from `kept`, 24 bytes a face
/// and 4 a vertex from `scratch` (which may be the same arena, and is rewound). kArenaTooSmall when
/// they do not fit, kInvalidMesh when an index is out of range.
Status buildAdjacency(const MeshView& mesh, Arena& kept, Arena& scratch, MeshAdjacency& adjacency);
inline Status buildAdjacency(const MeshView& mesh, Arena& arena, MeshAdjacency& adjacency) {
  return buildAdjacency(mesh, arena, arena, adjacency);
}

/// Axis-aligned bounding box of the vertices used by faces of matched parts, station frame.
struct BoundingBox {
  Eigen::Vector3d minimum_m = Eigen::Vector3d::Zero();  ///< least coordinates
  Eigen::Vector3d maximum_m = Eigen::Vector3d::Zero();  ///< largest coordinates
  /// Middle of the box, m.
  Eigen::Vector3d centre() const { return 0.5 * (minimum_m + maximum_m); }
  /// Length from corner to corner, m.
  double diagonal() const { return (maximum_m - minimum_m).norm(); }
};
BoundingBox matchedBounds(const MeshView& mesh);

}  // namespace boresight
