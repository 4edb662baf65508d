// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/mesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/math.h"

namespace boresight {
namespace {

/// One side of one face. Equal `ends` are the same edge of the mesh.
struct Side {
  std::uint64_t ends = 0;  ///< lower vertex index, then the higher one
  std::int32_t face = 0;
  std::int32_t edge = 0;  ///< 0..2 in the face
};

bool hasRepeatedVertex(const Face& face) {
  return face.vertex[0] == face.vertex[1] || face.vertex[1] == face.vertex[2] ||
         face.vertex[2] == face.vertex[0];
}

Side sideOf(const Face& face, std::size_t face_index, std::size_t edge) {
  const auto [low, high] = std::minmax(face.vertex[edge], face.vertex[(edge + 1) % 3]);
  return {(static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high),
          static_cast<std::int32_t>(face_index), static_cast<std::int32_t>(edge)};
}

/// Total: no two sides share face and edge.
bool sideBefore(const Side& a, const Side& b) {
  if (a.ends != b.ends) return a.ends < b.ends;
  return a.face != b.face ? a.face < b.face : a.edge < b.edge;
}

/// Sides of all faces that have three different vertices; how many there are.
std::size_t collectSides(const MeshView& mesh, std::span<Side> sides) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (hasRepeatedVertex(mesh.faces[f])) continue;
    for (std::size_t edge = 0; edge < 3; ++edge) sides[count++] = sideOf(mesh.faces[f], f, edge);
  }
  return count;
}

/// Joins the faces of every run of exactly two sides with the same ends.
void joinPairs(std::span<const Side> sides, std::span<std::array<std::int32_t, 3>> neighbour) {
  std::size_t first = 0;
  while (first < sides.size()) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].ends == sides[first].ends) ++end;
    if (end - first == 2) {
      const Side& a = sides[first];
      const Side& b = sides[first + 1];
      neighbour[static_cast<std::size_t>(a.face)][static_cast<std::size_t>(a.edge)] = b.face;
      neighbour[static_cast<std::size_t>(b.face)][static_cast<std::size_t>(b.edge)] = a.face;
    }
    first = end;
  }
}

bool validThresholds(const ScenePart& part) {
  return part.normal_threshold_rad >= 0.0 && isFinite(part.normal_threshold_rad) &&
         part.depth_threshold_m >= 0.0 && isFinite(part.depth_threshold_m);
}

}  // namespace

Status validateMesh(const MeshView& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::size_t vertex_count = mesh.vertices_in_station_m.size();
  if (mesh.faces.empty() || mesh.faces.size() > kMost || vertex_count > kMost)
    return Status::kInvalidMesh;
  if (mesh.parts.empty() || mesh.part_of_face.size() != mesh.faces.size())
    return Status::kInvalidMesh;
  for (const ScenePart& part : mesh.parts)
    if (!validThresholds(part)) return Status::kInvalidMesh;
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    if (!isFinite(static_cast<double>(vertex.x())) || !isFinite(static_cast<double>(vertex.y())) ||
        !isFinite(static_cast<double>(vertex.z())))
      return Status::kInvalidMesh;
  for (const Face& face : mesh.faces)
    for (const std::int32_t vertex : face.vertex)
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertex_count)
        return Status::kInvalidMesh;
  for (const std::uint16_t part : mesh.part_of_face)
    if (part >= mesh.parts.size()) return Status::kInvalidMesh;
  return Status::kOk;
}

Status buildAdjacency(const MeshView& mesh, Arena& arena, MeshAdjacency& adjacency) {
  adjacency.neighbour = {};
  const std::size_t face_count = mesh.faces.size();
  const auto neighbour = arena.allocate<std::array<std::int32_t, 3>>(face_count);
  const std::size_t scratch = arena.mark();
  const std::span<Side> sides = arena.allocate<Side>(3 * face_count);
  arena.rewind(scratch);
  if (arena.countsOnly()) return Status::kOk;
  if (arena.exhausted()) return Status::kArenaTooSmall;

  for (auto& of_face : neighbour) of_face = {-1, -1, -1};
  const std::span<Side> used = sides.first(collectSides(mesh, sides));
  std::sort(used.begin(), used.end(), sideBefore);
  joinPairs(used, neighbour);
  adjacency.neighbour = neighbour;
  return Status::kOk;
}

BoundingBox matchedBounds(const MeshView& mesh) {
  BoundingBox box;
  bool empty = true;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.parts[mesh.part_of_face[f]].match) continue;
    for (const std::int32_t index : mesh.faces[f].vertex) {
      const Eigen::Vector3d vertex =
          mesh.vertices_in_station_m[static_cast<std::size_t>(index)].cast<double>();
      box.minimum_m = empty ? vertex : Eigen::Vector3d(box.minimum_m.cwiseMin(vertex));
      box.maximum_m = empty ? vertex : Eigen::Vector3d(box.maximum_m.cwiseMax(vertex));
      empty = false;
    }
  }
  return box;
}

}  // namespace boresight
