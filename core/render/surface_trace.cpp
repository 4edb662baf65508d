// SPDX-License-Identifier: Apache-2.0
#include "core/render/surface_trace.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"

namespace boresight {
namespace {

/// A scanned surface has dozens of faces in the last pixel before its silhouette.
constexpr int kMaxHops = 64;

/// The edge through which a way leaves a triangle: the first whose value falls to zero.
struct Exit {
  int edge = -1;
  double s = 2.0;
};

/// Where the way from one ray to another leaves a face, seen from the camera, that it entered at a
/// place through an edge (-1: it begins there). The sign that turns the edges inwards is applied to
/// their values, which gives the same bits as faceEdges().
inline Exit findExit(const FaceCache::Edges& face, double sign, int entered_through,
                     double s_entered, const Eigen::Vector3d& ray_from,
                     const Eigen::Vector3d& ray_to) {
  Exit exit;
  for (int i = 0; i < 3; ++i) {
    if (i == entered_through) continue;
    const Eigen::Vector3d& line = nth(face.line, i);
    const double to = sign * dotProduct(line, ray_to);
    if (!(to <= 0.0)) continue;
    const double from = sign * dotProduct(line, ray_from);
    if (!(from > to)) continue;
    const double s = std::max(from > 0.0 ? from / (from - to) : 0.0, s_entered);
    if (s < exit.s) exit = {i, s};
  }
  return exit;
}

/// The corner of a face that is not on the edge to another face; -1: none.
inline int cornerBeyond(const MeshView& mesh, std::int32_t face, int edge, std::int32_t beyond) {
  const Face from = nth(mesh.faces, face);
  const Face to = nth(mesh.faces, beyond);
  const auto first = static_cast<std::size_t>(edge);
  const std::size_t second = (first + 1) % 3;
  for (int i = 2; i >= 0; --i) {
    const auto vertex = nth(to.vertex, i);
    if (vertex != from.vertex[first] && vertex != from.vertex[second]) return i;
  }
  return -1;
}

/// A face folds back behind the surface when its third corner lies on the surface's side of the
/// edge; this does not depend on the orientation of the mesh.
bool foldsBack(const Corners& face, int third, const Eigen::Vector3d& line) {
  return third < 0 || !(dotProduct(line, nth(face, third)) < 0.0);
}

int edgeTowards(const CameraScene& scene, std::int32_t face, std::int32_t neighbour) {
  for (int i = 0; i < 3; ++i)
    if (scene.adjacency.beyond(face, i) == neighbour) return i;
  return -1;
}

/// The neighbour along a face's longest edge, that to `from` (-1: none) left out.
std::int32_t acrossLongestEdge(const CameraScene& scene, std::int32_t face, std::int32_t from) {
  const Corners corner = scene.mesh.corners(static_cast<std::size_t>(face));
  std::int32_t across = -1;
  double longest2 = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d side = corner[(i + 1) % 3] - corner[i];
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
double nearness(const FaceCache::Plane& face, const FaceCache::Plane& other) {
  return dotProduct(face.plane, other.plane) * other.inverse_norm;
}

}  // namespace

FaceCache FaceCache::create(Arena& arena) {
  FaceCache cache;
  cache.planes_ = arena.allocate<Plane>(kPlanes);
  cache.edges_ = arena.allocate<Edges>(kEdges);
  return cache;
}

void FaceCache::clear() {
  for (Plane& found : planes_) found.face = -1;
  for (Edges& edges : edges_) edges.face = -1;
}

void FaceCache::fill(const CameraScene& scene, std::int32_t face, Plane& found) {
  // The same for a face without a plane, whatever it held.
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  found.face = face;
  const std::int32_t trusted = scene.normalKnown(face) ? face : trustedFace(scene, face);
  found.valid = planeThrough(corners(scene, trusted), plane);
  found.plane = plane;
  const double norm2 = dotProduct(plane, plane);
  found.inverse_norm = norm2 > 0.0 ? 1.0 / std::sqrt(norm2) : 0.0;
}

void FaceCache::fillLines(Edges& edges) {
  edges.lines_known = true;
  for (std::size_t i = 0; i < 3; ++i)
    edges.line[i] = crossProduct(edges.corner[i], edges.corner[(i + 1) % 3]);
  edges.determinant = dotProduct(edges.line[0], edges.corner[2]);
}

SurfaceEnd traceSurface(const CameraScene& scene, FaceCache& faces, std::int32_t start,
                        const Eigen::Vector3d& ray_from, const Eigen::Vector3d& ray_to,
                        std::int32_t target) {
  SurfaceEnd end;
  end.face = start;
  SurfaceEnd turn;
  FaceCache::Plane plane;  // of the face
  int entered_through = -1;
  for (int hop = 0; hop <= kMaxHops; ++hop) {
    const FaceCache::Edges& face = faces.edges(scene, end.face);
    if (!(face.determinant > 0.0 || face.determinant < 0.0)) break;
    const double sign = face.determinant < 0.0 ? -1.0 : 1.0;
    const Exit exit =
        findExit(face, sign, entered_through, end.ends ? end.s : 0.0, ray_from, ray_to);
    end.ends = exit.edge >= 0;
    end.s = exit.s;
    if (!end.ends) break;
    end.line = sign * nth(face.line, exit.edge);
    end.edge = static_cast<std::int8_t>(exit.edge);
    if (hop == kMaxHops) break;

    const std::int32_t next = scene.adjacency.beyond(end.face, exit.edge);
    if (next < 0) break;
    const int third = cornerBeyond(scene.mesh, end.face, exit.edge, next);
    if (foldsBack(faces.corners(scene, next), third, end.line)) break;
    if (next == target) {
      if (turn.ends) end = turn;
      end.reached = true;
      break;
    }
    if (hop == 0) plane = faces.plane(scene, start);
    const FaceCache::Plane next_plane = faces.plane(scene, next);
    if (!next_plane.valid ||
        normalsDiffer(plane, next_plane, scene.cos_normal_threshold[scene.partIndex(end.face)]))
      break;
    if (target >= 0 && !turn.ends &&
        nearness(next_plane, faces.plane(scene, target)) >
            nearness(next_plane, faces.plane(scene, start)))
      turn = end;
    entered_through = edgeTowards(scene, next, end.face);
    if (entered_through < 0) break;
    end.face = next;
    plane = next_plane;
  }
  return end;
}

}  // namespace boresight
