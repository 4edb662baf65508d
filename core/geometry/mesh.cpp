// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/mesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/math.h"
#include "core/base/nth.h"

namespace boresight {
namespace {

/// One side of one face, in the group of its lower vertex. Equal `high` are the same edge of the
/// mesh.
struct Side {
  std::int32_t high = 0;   ///< the higher vertex index
  std::uint32_t side = 0;  ///< 3 * face + edge
};

/// So that sides can be counted in 32 bits.
constexpr std::size_t kMostFaces = std::numeric_limits<std::uint32_t>::max() / 3;

bool hasRepeatedVertex(const Face& face) {
  return face.vertex[0] == face.vertex[1] || face.vertex[1] == face.vertex[2] ||
         face.vertex[2] == face.vertex[0];
}

/// Calls use(low, high, 3 * face + edge) for the sides of all faces that have three different
/// vertices, in order.
template <class Use>
void forEachSide(const MeshView& mesh, Use&& use) {
  std::uint32_t side = 0;
  for (const Face& face : mesh.faces) {
    const auto& v = face.vertex;
    const bool joins = !hasRepeatedVertex(face);
    for (std::size_t edge = 0; edge < 3; ++edge, ++side) {
      const std::int32_t from = v[edge];
      const std::int32_t to = v[edge < 2 ? edge + 1 : 0];
      if (joins) use(static_cast<std::size_t>(from < to ? from : to), from < to ? to : from, side);
    }
  }
}

bool indicesInRange(const MeshView& mesh) {
  const std::size_t vertex_count = mesh.vertices_in_station_m.size();
  bool in_range = true;
  for (const Face& face : mesh.faces)
    for (const std::int32_t vertex : face.vertex)
      in_range = in_range && vertex >= 0 && static_cast<std::size_t>(vertex) < vertex_count;
  return in_range;
}

/// Groups the sides by their lower vertex (counting sort): group v is sides[group_end[v - 1]] up to
/// sides[group_end[v]], in the order of faces.
void groupSides(const MeshView& mesh, std::span<std::uint32_t> group_end, std::span<Side> sides) {
  for (std::uint32_t& end : group_end) end = 0;
  forEachSide(mesh, [&](std::size_t low, std::int32_t, std::uint32_t) { ++group_end[low]; });
  std::uint32_t begin = 0;
  for (std::uint32_t& end : group_end) {
    const std::uint32_t count = end;
    end = begin;
    begin += count;
  }
  forEachSide(mesh, [&](std::size_t low, std::int32_t high, std::uint32_t side) {
    sides[group_end[low]++] = {high, side};
  });
}

/// Joins the faces of every run of exactly two sides with the same ends. `sides`: one group.
void joinPairs(std::span<Side> sides, MeshAdjacency& adjacency) {
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.high != b.high ? a.high < b.high : a.side < b.side;
  });
  std::size_t first = 0;
  while (first < sides.size()) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].high == sides[first].high) ++end;
    if (end - first == 2) adjacency.join(sides[first].side, sides[first + 1].side);
    first = end;
  }
}

bool isValid(const ScenePart& part) {
  return part.normal_threshold_rad >= 0.0 && isFinite(part.normal_threshold_rad) &&
         part.depth_threshold_m >= 0.0 && isFinite(part.depth_threshold_m) &&
         !(part.fixed_to_camera && part.match);
}

/// Whether no face mixes vertices of the two frames, given valid indices.
bool framesAreApart(const MeshView& mesh) {
  const std::size_t first_in_camera = firstVertexInCamera(mesh);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.partOf(f).fixed_to_camera) continue;
    for (const std::int32_t vertex : mesh.faces[f].vertex)
      if (static_cast<std::size_t>(vertex) >= first_in_camera) return false;
  }
  return true;
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
    if (!isValid(part)) return Status::kInvalidMesh;
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    if (!vertex.allFinite()) return Status::kInvalidMesh;
  if (!indicesInRange(mesh)) return Status::kInvalidMesh;
  for (const std::uint16_t part : mesh.part_of_face)
    if (part >= mesh.parts.size()) return Status::kInvalidMesh;
  return framesAreApart(mesh) ? Status::kOk : Status::kInvalidMesh;
}

std::size_t firstVertexInCamera(const MeshView& mesh) {
  std::size_t first = mesh.vertices_in_station_m.size();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.partOf(f).fixed_to_camera) continue;
    for (const std::int32_t vertex : mesh.faces[f].vertex)
      first = std::min(first, static_cast<std::size_t>(vertex));
  }
  return first;
}

Status buildAdjacency(const MeshView& mesh, Arena& kept, Arena& scratch, MeshAdjacency& adjacency) {
  adjacency = {};
  const std::size_t face_count = mesh.faces.size();
  MeshAdjacency built = MeshAdjacency::create(face_count, kept);
  const std::size_t mark = scratch.mark();
  const auto sides = scratch.allocate<Side>(3 * face_count);
  const auto group_end = scratch.allocate<std::uint32_t>(mesh.vertices_in_station_m.size());
  scratch.rewind(mark);
  if (kept.countsOnly()) return Status::kOk;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;
  if (face_count > kMostFaces || !indicesInRange(mesh)) return Status::kInvalidMesh;

  groupSides(mesh, group_end, sides);
  std::uint32_t begin = 0;
  for (const std::uint32_t end : group_end) {
    if (end - begin > 1) joinPairs(sides.subspan(begin, end - begin), built);
    begin = end;
  }
  adjacency = built;
  return Status::kOk;
}

BoundingBox boxOf(const Eigen::AlignedBox3f& bounds_m) {
  if (bounds_m.isEmpty()) return {};
  return {bounds_m.min().cast<double>(), bounds_m.max().cast<double>()};
}

BoundingBox matchedBounds(const MeshView& mesh) {
  Eigen::AlignedBox3f bounds_m;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.partOf(f).match) continue;
    for (const std::int32_t vertex : mesh.faces[f].vertex)
      bounds_m.extend(nth(mesh.vertices_in_station_m, vertex));
  }
  return boxOf(bounds_m);
}

}  // namespace boresight
