// SPDX-License-Identifier: Apache-2.0
// Intersections of rays with a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Intersection of a ray with a face.
struct RayHit {
  double distance = 0.0;  ///< in lengths of the ray's direction
  std::int32_t face = -1;
};

/// The faces of a mesh in a tree of boxes (bounding volume hierarchy, split at the median of the
/// widest axis), so that a ray is tested against few faces: microseconds for a hundred thousand.
class FaceTree {
 public:
  /// `mesh` must outlive it, and be valid.
  explicit FaceTree(const MeshView& mesh);

  /// The first face along a ray, seen from either side, nearer than `farthest` (in lengths of
  /// `direction`); empty when it misses all.
  std::optional<RayHit> firstHit(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                                 double farthest = std::numeric_limits<double>::infinity()) const;

  const Eigen::AlignedBox3d& bounds_m() const { return nodes_.front().box_m; }

 private:
  /// Faces first ... first + count of the order; a node that is no leaf has its two halves at
  /// `child` and the place after it.
  struct Node {
    Eigen::AlignedBox3d box_m;
    std::int32_t first = 0;
    std::int32_t count = 0;
    std::int32_t child = -1;
  };

  void addNode(std::int32_t first, std::int32_t count);
  void split(std::size_t node, const std::vector<Eigen::Vector3d>& middle_m);

  MeshView mesh_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

/// The surface that is visible at a pixel.
struct SurfacePoint {
  Eigen::Vector3d in_station_m = Eigen::Vector3d::Zero();
  double depth_m = 0.0;  ///< z in the camera frame
  std::int32_t face = -1;
};

/// The nearest surface on the ray through a pixel, over all faces (some milliseconds for a hundred
/// thousand); empty where the ray meets none or the camera has no ray there.
std::optional<SurfacePoint> surfacePointAt(const Camera& camera, const MeshView& mesh,
                                           const Pose& camera_from_station,
                                           const Eigen::Vector2d& pixel);

/// A distance that an operator measures on an image.
struct Measurement {
  double image_px = 0.0;
  std::optional<double> surface_m;  ///< straight, where both ends are on the station
};
Measurement measureBetween(const Camera& camera, const MeshView& mesh,
                           const Pose& camera_from_station, const Eigen::Vector2d& from_px,
                           const Eigen::Vector2d& to_px);

}  // namespace boresight::sessions
