// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/mesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/math.h"

namespace boresight {
namespace {

/// A side of a face by its number, 3 face + edge: what is compared is looked up in the mesh, so
/// that sorting them takes no more memory than the adjacency itself.
using Side = std::uint32_t;
constexpr std::size_t kMostFaces = std::numeric_limits<std::int32_t>::max() / 3;

bool hasRepeatedVertex(const Face& face) {
  return face.vertex[0] == face.vertex[1] || face.vertex[1] == face.vertex[2] ||
         face.vertex[2] == face.vertex[0];
}

/// Lower vertex index, then the higher one; equal ends are the same edge of the mesh.
std::uint64_t endsOf(const MeshView& mesh, Side side) {
  const Face& face = mesh.faces[side / 3];
  const auto [low, high] = std::minmax(face.vertex[side % 3], face.vertex[(side + 1) % 3]);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
}

/// Sides of all faces that have three different vertices; how many there are.
std::size_t collectSides(const MeshView& mesh, std::span<Side> sides) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (hasRepeatedVertex(mesh.faces[f])) continue;
    for (std::size_t edge = 0; edge < 3; ++edge) sides[count++] = static_cast<Side>(3 * f + edge);
  }
  return count;
}

/// Joins the faces of every run of exactly two sides with the same ends.
void joinPairs(const MeshView& mesh, std::span<const Side> sides,
               std::span<std::array<std::int32_t, 3>> neighbour) {
  std::size_t first = 0;
  while (first < sides.size()) {
    const std::uint64_t ends = endsOf(mesh, sides[first]);
    std::size_t end = first + 1;
    while (end < sides.size() && endsOf(mesh, sides[end]) == ends) ++end;
    if (end - first == 2) {
      const Side a = sides[first];
      const Side b = sides[first + 1];
      neighbour[a / 3][a % 3] = static_cast<std::int32_t>(b / 3);
      neighbour[b / 3][b % 3] = static_cast<std::int32_t>(a / 3);
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
  if (mesh.faces.empty() || mesh.faces.size() > kMostFaces || vertex_count > kMost)
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

Status buildAdjacency(const MeshView& mesh, Arena& kept, Arena& scratch, MeshAdjacency& adjacency) {
  adjacency.neighbour = {};
  const std::size_t face_count = mesh.faces.size();
  const auto neighbour = kept.allocate<std::array<std::int32_t, 3>>(face_count);
  const std::size_t mark = scratch.mark();
  const std::span<Side> sides = scratch.allocate<Side>(3 * face_count);
  scratch.rewind(mark);
  if (kept.countsOnly() || scratch.countsOnly()) return Status::kOk;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;

  for (auto& of_face : neighbour) of_face = {-1, -1, -1};
  const std::span<Side> used = sides.first(collectSides(mesh, sides));
  // The numbers tell apart what has the same ends: the order is total.
  std::sort(used.begin(), used.end(), [&mesh](Side a, Side b) {
    const std::uint64_t ends_a = endsOf(mesh, a);
    const std::uint64_t ends_b = endsOf(mesh, b);
    return ends_a != ends_b ? ends_a < ends_b : a < b;
  });
  joinPairs(mesh, used, neighbour);
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
