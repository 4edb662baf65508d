// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/nth.h"
#include "core/base/status.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/render/ray_grid.h"

namespace boresight {

/// A vertex's pixel in 16 bits: rounded to 1 / FixedScale::steps() px, counted from the middle of
/// the image.
struct FixedPixel {
  std::int16_t x = 0;  ///< steps to the right of the middle
  std::int16_t y = 0;  ///< steps below the middle
  /// Both coordinates of a vertex that has no usable pixel.
  static constexpr std::int16_t kNotProjected = -32000;
};

/// Conversion of pixels and depths of one render to 16 bits, with the finest steps that the image's
/// size and the scene's depth allow.
struct FixedScale {
  static constexpr int kLimit = 31000;  ///< pixels farther off are moved here, outside the image
  int shift = 0;                        ///< 2^shift steps to a pixel
  int middle_x = 0;                     ///< the pixel from which coordinates are counted
  int middle_y = 0;                     ///< likewise
  double low_m = 0.0;                   ///< z of depth 0
  double per_m = 0.0;                   ///< steps of depth per metre
  int gap = 0;                          ///< depths this far apart differ by more than rounding

  /// Steps to a pixel.
  int steps() const { return 1 << shift; }
};

/// The mesh seen from one pose: the pixels and depths of its vertices in 16 bits, for bounds and
/// for decisions beyond rounding. Vertices in the camera frame (where the entrance pupil moves: as
/// seen from the pupil of their own rays) are recomputed on demand: stored, they would be the
/// largest part of a render's memory. Refilled for every pose.
struct CameraScene {
  /// Surfaces nearer than this are not rendered: no camera is in focus there.
  static constexpr double kNearPlane_m = 0.01;

  MeshView mesh;                           ///< not owned
  MeshAdjacency adjacency;                 ///< of the mesh
  std::size_t first_in_camera = 0;         ///< vertices from here on are fixed to the camera
  BoundingBox station_box;                 ///< of the vertices before those, station frame
  BoundingBox camera_box;                  ///< of the others, camera frame
  std::span<FixedPixel> vertex_px;         ///< one per vertex of the mesh
  std::span<std::uint16_t> vertex_depth;   ///< one per vertex: floor((z - low_m) per_m)
  FixedScale scale;                        ///< of pixels and depths
  std::span<double> cos_normal_threshold;  ///< per part
  /// Per face: bit i when the surface continues smoothly over edge i to a face of the same
  /// orientation; kFrontFacing when the outer side is seen from this pose; kNormalKnown when the
  /// face is wide enough for its normal to be known.
  std::span<std::uint8_t> face_flags;
  /// Bit of face_flags.
  static constexpr std::uint8_t kFrontFacing = 8;
  /// Bit of face_flags.
  static constexpr std::uint8_t kNormalKnown = 16;

  /// The mesh and its adjacency must outlive the scene. Data that depends on the pose comes from
  /// `scratch`.
  static Status create(const MeshView& mesh, const MeshAdjacency& adjacency, Arena& kept,
                       Arena& scratch, CameraScene& scene);

  /// Sets pose and scale of a render; before `transform`. Where the rays are those of a view turned
  /// from the camera, `camera_from_station` is the view's pose, and `turn` is view_from_camera.
  void begin(const Pose& camera_from_station, const RayGrid& rays, const Pose& turn = Pose());
  /// Pixels and depths of vertices first .. last - 1.
  void transform(const RayGrid& rays, std::size_t first, std::size_t last);

  /// Sets a face's kFrontFacing.
  void orient(std::int32_t face);
  /// Sets or clears a face's kFrontFacing.
  void setFrontFacing(std::int32_t face, bool front) {
    std::uint8_t& flags = nth(face_flags, face);
    flags = static_cast<std::uint8_t>(front ? flags | kFrontFacing : flags & ~kFrontFacing);
  }
  /// A face's kFrontFacing.
  bool isFrontFacing(std::int32_t face) const {
    return (nth(face_flags, face) & kFrontFacing) != 0;
  }

  /// A face's kNormalKnown.
  bool normalKnown(std::int32_t face) const { return (nth(face_flags, face) & kNormalKnown) != 0; }

  /// True when two faces share an edge over which the surface continues smoothly and show the same
  /// side, without a salient edge between them.
  bool continues(std::int32_t face, std::int32_t other) const {
    const std::uint8_t flags = nth(face_flags, face);
    if (((flags ^ nth(face_flags, other)) & kFrontFacing) != 0) return false;
    for (int i = 0; i < 3; ++i)
      if ((flags >> i & 1) != 0 && adjacency.beyond(face, i) == other) return true;
    return false;
  }

  /// A vertex, camera frame, m.
  Eigen::Vector3d vertex(std::int32_t index) const {
    const bool in_station = static_cast<std::size_t>(index) < first_in_camera;
    const Placement& placed = in_station ? station_ : camera_;
    const Eigen::Vector3d point = placed.place(mesh.vertex(index));
    return pupil_moves_ ? seenFromPupil(rays_camera_, point) : point;
  }
  /// The corners of a face, camera frame, m.
  Corners corners(std::int32_t face) const {
    const Face indices = nth(mesh.faces, face);
    return {vertex(indices.vertex[0]), vertex(indices.vertex[1]), vertex(indices.vertex[2])};
  }
  /// The part that a face belongs to.
  const ScenePart& part(std::int32_t face) const { return mesh.parts[partIndex(face)]; }
  /// Index of a face's part in the mesh's parts.
  std::size_t partIndex(std::int32_t face) const { return nth(mesh.part_of_face, face); }

 private:
  /// A pose as rotation matrix and translation.
  struct Placement {
    Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
    Eigen::Vector3d t_m = Eigen::Vector3d::Zero();

    Placement() = default;
    explicit Placement(const Pose& pose) : r(pose.matrix()), t_m(pose.translation_m) {}
    /// The same terms in the same order as for a block of vertices.
    Eigen::Vector3d place(const Eigen::Vector3d& p) const {
      Eigen::Vector3d placed;
      for (int k = 0; k < 3; ++k)
        placed[k] = ((r(k, 0) * p[0] + r(k, 1) * p[1]) + r(k, 2) * p[2]) + t_m[k];
      return placed;
    }
  };

  void transformBy(const Placement& placed, const RayGrid& rays, std::size_t first,
                   std::size_t last);
  Eigen::Vector3d outerNormal(std::size_t face) const;
  bool normalIsKnown(std::size_t face, const Eigen::Vector3d& normal) const;
  void setFlags(std::size_t face);

  Placement station_;         ///< camera_from_station of the current render
  Placement camera_;          ///< view_from_camera of the current render
  bool pupil_moves_ = false;  ///< of the camera
  Camera rays_camera_;        ///< the camera rendered with
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
[[nodiscard]] bool faceEdges(const Corners& corners, Eigen::Vector3d edge[3]);

/// The plane through a point with a normal of any length, as 1/z = plane . ray. False when the
/// camera's centre lies in it.
[[nodiscard]] inline bool planeOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& point,
                                  Eigen::Vector3d& plane) {
  const double inverse = 1.0 / dotProduct(normal, point);
  if (!(std::abs(inverse) < 1e300)) return false;
  plane = normal * inverse;
  return true;
}

/// The plane of a face with these corners as 1/z = plane . ray; it points away from the camera, so
/// -plane / |plane| is the face's unit normal on the camera's side, and 1 / |plane| its distance in
/// metres. False when the face is degenerate or seen exactly edge-on.
[[nodiscard]] inline bool planeThrough(const Corners& corners, Eigen::Vector3d& plane) {
  const auto& [v0, v1, v2] = corners;
  return planeOf(crossProduct(v1 - v0, v2 - v0), v0, plane);
}

/// Pixels that a face can cover: a conservative rectangle, empty when it holds no pixel centre.
struct PixelBounds {
  int x_first = 0;  ///< leftmost column
  int x_last = -1;  ///< rightmost column
  int y_first = 0;  ///< uppermost row
  int y_last = -1;  ///< lowest row
  /// Whether it holds no pixel centre.
  bool empty() const { return x_last < x_first || y_last < y_first; }
};
PixelBounds faceBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face);

}  // namespace boresight
