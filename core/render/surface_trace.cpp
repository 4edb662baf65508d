// SPDX-License-Identifier: Apache-2.0
#include "core/render/surface_trace.h"

#include <algorithm>
#include <cmath>

namespace boresight {
namespace {

/// A scanned surface has dozens of faces in the last pixel before its silhouette.
constexpr int kMaxHops = 64;

/// The edge through which a way leaves a triangle: the first whose value falls to zero.
struct Exit {
  int edge = -1;
  double s = 2.0;
  Eigen::Vector3d line = Eigen::Vector3d::Zero();  ///< line . ray > 0 on the triangle's side
};

/// Where the way from one ray to another leaves a face that it entered at a place through an edge
/// (-1: it begins there). False when the face, given by its corners, has no area seen from the
/// camera. The edges are those of faceEdges(), without the one passed already; the sign that turns
/// them inwards is applied to their values, which gives the same bits.
inline bool findExit(const Corners& vertex, int entered_through, double s_entered,
                     const Eigen::Vector3d& ray_from, const Eigen::Vector3d& ray_to, Exit& exit) {
  Eigen::Vector3d line = crossProduct(vertex[0], vertex[1]);
  const double determinant = dotProduct(line, vertex[2]);
  if (!(determinant > 0.0 || determinant < 0.0)) return false;
  const double sign = determinant < 0.0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    if (i == entered_through) continue;
    if (i > 0)
      line = crossProduct(vertex[static_cast<std::size_t>(i)],
                          vertex[static_cast<std::size_t>(i < 2 ? i + 1 : 0)]);
    const double to = sign * dotProduct(line, ray_to);
    if (!(to <= 0.0)) continue;
    const double from = sign * dotProduct(line, ray_from);
    if (!(from > to)) continue;
    const double s = std::max(from > 0.0 ? from / (from - to) : 0.0, s_entered);
    if (s < exit.s) exit = {i, s, sign * line};
  }
  return true;
}

/// The corners of the face beyond an edge: two are those of this face.
struct Beyond {
  Corners corner;
  int third = -1;  ///< the corner that is not on the edge; -1: none
};

inline Beyond beyondEdge(const CameraScene& scene, std::int32_t face, const Corners& corner,
                         int edge, std::int32_t beyond) {
  const Face from = scene.mesh.faces[static_cast<std::size_t>(face)];
  const Face to = scene.mesh.faces[static_cast<std::size_t>(beyond)];
  const auto first = static_cast<std::size_t>(edge);
  const std::size_t second = (first + 1) % 3;
  Beyond found;
  for (std::size_t i = 0; i < 3; ++i) {
    if (to.vertex[i] == from.vertex[first]) {
      found.corner[i] = corner[first];
    } else if (to.vertex[i] == from.vertex[second]) {
      found.corner[i] = corner[second];
    } else {
      found.corner[i] = scene.vertex(to.vertex[i]);
      found.third = static_cast<int>(i);
    }
  }
  return found;
}

/// A face folds back behind the surface when its third corner lies on the surface's side of the
/// edge; this does not depend on the orientation of the mesh.
bool foldsBack(const Beyond& face, const Eigen::Vector3d& line) {
  return face.third < 0 ||
         !(dotProduct(line, face.corner[static_cast<std::size_t>(face.third)]) < 0.0);
}

int edgeTowards(const CameraScene& scene, std::int32_t face, std::int32_t neighbour) {
  for (int i = 0; i < 3; ++i)
    if (scene.adjacency.beyond(face, i) == neighbour) return i;
  return -1;
}

/// The neighbour along a face's longest edge, that to `from` (-1: none) left out.
std::int32_t acrossLongestEdge(const CameraScene& scene, std::int32_t face, std::int32_t from) {
  const Face indices = scene.mesh.faces[static_cast<std::size_t>(face)];
  std::int32_t across = -1;
  double longest2 = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d begin =
        scene.mesh.vertices_in_station_m[static_cast<std::size_t>(indices.vertex[i])]
            .cast<double>();
    const Eigen::Vector3d end =
        scene.mesh.vertices_in_station_m[static_cast<std::size_t>(indices.vertex[(i + 1) % 3])]
            .cast<double>();
    const Eigen::Vector3d side = end - begin;
    const double side2 = dotProduct(side, side);
    const std::int32_t beyond = scene.adjacency.beyond(face, static_cast<int>(i));
    if (side2 <= longest2 || (from >= 0 && beyond == from)) continue;
    longest2 = side2;
    across = beyond;
  }
  return across;
}

/// For a face that is too narrow for its normal to be known: the first face along the longest edges
/// that is wide enough, or the face itself where there is none.
std::int32_t trustedFace(const CameraScene& scene, std::int32_t face) {
  std::int32_t at = face;
  std::int32_t from = -1;
  for (int hop = 0; hop < 8 && at >= 0; ++hop) {
    if (scene.normalKnown(at)) return at;
    const std::int32_t next = acrossLongestEdge(scene, at, from);
    from = at;
    at = next;
  }
  return face;
}

/// Cosine-like similarity of two faces' normals.
double nearness(const PlaneCache::Entry& face, const PlaneCache::Entry& other) {
  return dotProduct(face.plane, other.plane) * other.inverse_norm;
}

}  // namespace

PlaneCache PlaneCache::create(Arena& arena) {
  PlaneCache cache;
  cache.entries_ = arena.allocate<Entry>(kEntries);
  return cache;
}

void PlaneCache::clear() {
  for (Entry& entry : entries_) entry = Entry();
}

void PlaneCache::fill(const CameraScene& scene, std::int32_t face, Entry& entry) {
  // The same for a face without a plane, whatever the entry held.
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  entry.face = face;
  entry.valid = facePlane(scene, scene.normalKnown(face) ? face : trustedFace(scene, face), plane);
  entry.plane = plane;
  const double norm2 = dotProduct(plane, plane);
  entry.inverse_norm = norm2 > 0.0 ? 1.0 / std::sqrt(norm2) : 0.0;
}

SurfaceEnd traceSurface(const CameraScene& scene, PlaneCache& planes, std::int32_t start,
                        const Eigen::Vector3d& ray_from, const Eigen::Vector3d& ray_to,
                        std::int32_t target) {
  SurfaceEnd end;
  end.face = start;
  SurfaceEnd turn;
  PlaneCache::Entry plane;  // of the face
  Corners corner = scene.corners(start);
  int entered_through = -1;
  for (int hop = 0; hop <= kMaxHops; ++hop) {
    Exit exit;
    if (!findExit(corner, entered_through, end.ends ? end.s : 0.0, ray_from, ray_to, exit)) break;
    end.ends = exit.edge >= 0;
    end.s = exit.s;
    if (!end.ends) break;
    end.line = exit.line;
    end.edge = static_cast<std::int8_t>(exit.edge);
    if (hop == kMaxHops) break;

    const std::int32_t next = scene.adjacency.beyond(end.face, exit.edge);
    if (next < 0) break;
    const Beyond beyond = beyondEdge(scene, end.face, corner, exit.edge, next);
    if (foldsBack(beyond, end.line)) break;
    if (next == target) {
      if (turn.ends) end = turn;
      end.reached = true;
      break;
    }
    if (hop == 0) plane = planes.get(scene, start);
    const PlaneCache::Entry next_plane = planes.get(scene, next);
    if (!next_plane.valid ||
        normalsDiffer(plane, next_plane, scene.cos_normal_threshold[scene.partIndex(end.face)]))
      break;
    if (target >= 0 && !turn.ends &&
        nearness(next_plane, planes.get(scene, target)) >
            nearness(next_plane, planes.get(scene, start)))
      turn = end;
    entered_through = edgeTowards(scene, next, end.face);
    if (entered_through < 0) break;
    end.face = next;
    corner = beyond.corner;
    plane = next_plane;
  }
  return end;
}

}  // namespace boresight
