// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/render/camera_scene.h"

namespace boresight {

/// Cache of the planes (see planeThrough) and edges of the latest faces: neighbouring pixels need
/// the same few faces.
class FaceCache {
 public:
  /// A face and its plane.
  struct Plane {
    std::int32_t face = -1;                           ///< -1: empty
    bool valid = false;                               ///< it has a plane
    Eigen::Vector3d plane = Eigen::Vector3d::Zero();  ///< 1/z = plane . ray
    double inverse_norm = 0.0;  ///< distance of the plane from the camera centre, m
  };

  /// A face's corners, and its edges seen from the camera's centre: corner i x corner i + 1.
  struct Edges {
    std::int32_t face = -1;               ///< -1: empty
    bool lines_known = false;             ///< otherwise only the corners are
    Corners corner;                       ///< camera frame, m
    std::array<Eigen::Vector3d, 3> line;  ///< determinant (line . ray) > 0 on the face's side
    double determinant = 0.0;             ///< of the corners; 0: no area seen from the camera
  };

  static FaceCache create(Arena& arena);  ///< Takes its memory from `arena`
  void clear();                           ///< Removes all faces
  /// Valid until the next call.
  const Plane& plane(const CameraScene& scene, std::int32_t face) {
    Plane& found = planes_[static_cast<std::size_t>(face) % kPlanes];
    if (found.face != face) fill(scene, face, found);
    return found;
  }
  /// Valid until the next call.
  const Edges& edges(const CameraScene& scene, std::int32_t face) {
    Edges& edges = cornersOf(scene, face);
    if (!edges.lines_known) fillLines(edges);
    return edges;
  }
  /// The same for the corners of a face alone.
  const Corners& corners(const CameraScene& scene, std::int32_t face) {
    return cornersOf(scene, face).corner;
  }

 private:
  static constexpr std::size_t kPlanes = 256;
  static constexpr std::size_t kEdges = 128;  ///< four times as large
  Edges& cornersOf(const CameraScene& scene, std::int32_t face) {
    Edges& edges = edges_[static_cast<std::size_t>(face) % kEdges];
    if (edges.face != face) {
      edges.face = face;
      edges.lines_known = false;
      edges.corner = scene.corners(face);
    }
    return edges;
  }
  void fill(const CameraScene& scene, std::int32_t face, Plane& found);
  static void fillLines(Edges& edges);
  std::span<Plane> planes_;
  std::span<Edges> edges_;
};

/// True when two surfaces' normals, both taken on the camera's side, differ by more than the angle
/// whose cosine is given.
inline bool normalsDiffer(const FaceCache::Plane& a, const FaceCache::Plane& b,
                          double cos_threshold) {
  return dotProduct(a.plane, b.plane) * (a.inverse_norm * b.inverse_norm) < cos_threshold;
}

/// End of a surface on the path from the centre of one pixel (s = 0) to another's (s = 1).
struct SurfaceEnd {
  bool ends = false;       ///< false: the surface covers the whole way
  bool reached = false;    ///< the way leads over one connected surface to the target face
  double s = 2.0;          ///< where the surface ends; above 1: it does not end
  std::int32_t face = -1;  ///< the face that ends there
  std::int8_t edge = -1;   ///< the edge of that face
  Eigen::Vector3d line = Eigen::Vector3d::Zero();  ///< line . ray > 0 on the surface's side
};

/// Follows the surface from `start` over edges across which it continues smoothly and faces the
/// camera. Silhouettes of tessellated curved surfaces consist of slivers narrower than a pixel;
/// stopping at the first face's edge would shift them inwards. When `target` (-1: none) is reached,
/// `s` and `line` are where the normal turns from the start's to the target's.
SurfaceEnd traceSurface(const CameraScene& scene, FaceCache& faces, std::int32_t start,
                        const Eigen::Vector3d& ray_from, const Eigen::Vector3d& ray_to,
                        std::int32_t target);

}  // namespace boresight
