// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <Eigen/Geometry>

#include "core/base/arena.h"
#include "core/base/index_list.h"
#include "core/base/nth.h"
#include "core/base/status.h"

namespace boresight {

/// One triangle: indices of its vertices, counter-clockwise seen from outside (back faces are also
/// rendered: coarse meshes are not always oriented).
struct Face {
  std::array<std::int32_t, 3> vertex{};  ///< indices into MeshView::vertices_in_station_m
};

/// A face in 16 bits, for meshes of at most kShortVertices vertices.
using ShortFace = std::array<std::uint16_t, 3>;
inline constexpr std::size_t kShortVertices = 65536;

/// A view of triangles in either form; they are read as Face.
class FaceList {
 public:
  FaceList() = default;
  /// Any contiguous range of faces.
  template <class Faces>
  requires std::is_convertible_v<const Faces&, std::span<const Face>> FaceList(const Faces& faces)
      : FaceList(std::span<const Face>(faces)) {}
  /// Of 32-bit indices.
  FaceList(std::span<const Face> faces) : long_(faces.data()), size_(faces.size()) {}
  /// Of 16-bit indices.
  FaceList(std::span<const ShortFace> faces) : short_(faces.data()), size_(faces.size()) {}

  /// Number of faces.
  std::size_t size() const { return size_; }
  /// Whether there are no faces.
  bool empty() const { return size_ == 0; }
  /// A face.
  Face operator[](std::size_t at) const {
    if (short_ == nullptr) return long_[at];
    const ShortFace& face = short_[at];
    return {{face[0], face[1], face[2]}};
  }
  /// The first `count` faces.
  FaceList first(std::size_t count) const {
    FaceList some = *this;
    some.size_ = count;
    return some;
  }

  /// Calls use(i, vertices of face first + i) for `count` faces; for tight loops.
  template <class Use>
  void forEach(std::size_t first, std::size_t count, Use&& use) const {
    if (short_ != nullptr) {
      for (std::size_t i = 0; i < count; ++i) use(i, short_[first + i]);
    } else {
      for (std::size_t i = 0; i < count; ++i) use(i, long_[first + i].vertex);
    }
  }

  /// Iterates over the faces by value.
  class Iterator {
   public:
    /// At a face of a list.
    Iterator(const FaceList& list, std::size_t at) : list_(&list), at_(at) {}
    /// The face.
    Face operator*() const { return (*list_)[at_]; }
    /// The next face.
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    /// At the same face.
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const FaceList* list_;
    std::size_t at_;
  };
  Iterator begin() const { return {*this, 0}; }    ///< The first face
  Iterator end() const { return {*this, size_}; }  ///< Behind the last face

 private:
  const Face* long_ = nullptr;
  const ShortFace* short_ = nullptr;
  std::size_t size_ = 0;
};

/// Bytes of a face in the shorter form that fits the number of vertices.
constexpr std::size_t bytesPerFace(std::size_t vertices) {
  return vertices <= kShortVertices ? sizeof(ShortFace) : sizeof(Face);
}

/// Thresholds and role of one part of the scene.
struct ScenePart {
  double normal_threshold_rad = 0.5235987755982988;  ///< 30 deg
  /// Surfaces this far apart in depth have an edge between them.
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

/// The corners of a face.
using Corners = std::array<Eigen::Vector3d, 3>;

/// The scene, owned by the caller: welded vertices in the station frame (metres), faces, and the
/// part of each face. Single precision is 3e-8 m at 0.5 m, far below any edge's accuracy.
struct MeshView {
  /// Metres. The vertices of parts fixed to the camera come last, and are in the camera frame.
  std::span<const Eigen::Vector3f> vertices_in_station_m;
  FaceList faces;                               ///< triangles
  std::span<const std::uint16_t> part_of_face;  ///< index into parts, one per face
  std::span<const ScenePart> parts;             ///< at least one

  /// The part that a face belongs to.
  const ScenePart& partOf(std::size_t face) const { return parts[part_of_face[face]]; }
  /// A vertex, metres.
  Eigen::Vector3d vertex(std::int32_t index) const {
    return nth(vertices_in_station_m, index).cast<double>();
  }
  /// The corners of a face, metres.
  Corners corners(std::size_t face) const {
    const Face indices = faces[face];
    return {vertex(indices.vertex[0]), vertex(indices.vertex[1]), vertex(indices.vertex[2])};
  }
};

/// kInvalidMesh when there are no faces, an index is out of range, a coordinate or threshold is not
/// finite (or a threshold negative), the part of a face does not exist, or a part fixed to the
/// camera is matched or has vertices before those of another part. Degenerate faces (zero area) are
/// allowed and never rendered.
Status validateMesh(const MeshView& mesh);

/// Index of the first vertex in the camera frame: the lowest one used by parts fixed to the camera;
/// the number of vertices without such parts.
std::size_t firstVertexInCamera(const MeshView& mesh);

/// Per face the face on the other side of edge i (vertex i to vertex (i + 1) % 3), or -1 at a
/// border or where more than two faces meet. Faces with a repeated vertex have no neighbours.
class MeshAdjacency {
 public:
  /// Takes the memory from `arena`; no face has neighbours yet.
  static MeshAdjacency create(std::size_t faces, Arena& arena) {
    MeshAdjacency adjacency;
    adjacency.neighbour_ = IndexList::create(3 * faces, faces, arena);
    return adjacency;
  }
  /// Number of faces.
  std::size_t size() const { return neighbour_.size() / 3; }
  /// The face beyond an edge (0 ... 2) of a face, or -1.
  std::int32_t beyond(std::int32_t face, int edge) const {
    return neighbour_[3 * static_cast<std::size_t>(face) + static_cast<std::size_t>(edge)];
  }
  /// Joins two sides, each 3 * face + edge.
  void join(std::uint32_t side, std::uint32_t other) {
    neighbour_.set(side, static_cast<std::int32_t>(other / 3));
    neighbour_.set(other, static_cast<std::int32_t>(side / 3));
  }

 private:
  IndexList neighbour_;  ///< three per face
};

/// Builds the adjacency; deterministic, O(n log n). The output comes from `kept`, 24 bytes per face
/// and 4 per vertex from `scratch` (which may be the same arena, and is rewound). kArenaTooSmall
/// when they do not fit, kInvalidMesh when an index is out of range.
Status buildAdjacency(const MeshView& mesh, Arena& kept, Arena& scratch, MeshAdjacency& adjacency);
inline Status buildAdjacency(const MeshView& mesh, Arena& arena, MeshAdjacency& adjacency) {
  return buildAdjacency(mesh, arena, arena, adjacency);
}

/// An axis-aligned box, m.
struct BoundingBox {
  Eigen::Vector3d minimum_m = Eigen::Vector3d::Zero();  ///< least coordinates
  Eigen::Vector3d maximum_m = Eigen::Vector3d::Zero();  ///< largest coordinates
  /// Middle of the box, m.
  Eigen::Vector3d centre() const { return 0.5 * (minimum_m + maximum_m); }
  /// Length from corner to corner, m.
  double diagonal() const { return (maximum_m - minimum_m).norm(); }
  /// One of the eight corners: bit k of `index` chooses the largest coordinate k.
  Eigen::Vector3d corner(int index) const {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) point[k] = ((index >> k) & 1) != 0 ? maximum_m[k] : minimum_m[k];
    return point;
  }
};
/// The same box in double precision; zeros when it is empty.
BoundingBox boxOf(const Eigen::AlignedBox3f& bounds_m);
/// The box of the vertices used by faces of matched parts, station frame; zeros without such faces.
BoundingBox matchedBounds(const MeshView& mesh);

}  // namespace boresight
