// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tests/core/render/scenes.h"

namespace boresight::testing {

/// What a ray from the camera centre meets first (Moller-Trumbore; nothing shared with the
/// rasterizer).
struct RayHit {
  int face = -1;
  double depth_m = 0.0;
};

class RayCaster {
 public:
  RayCaster(const SceneMesh& mesh, const Pose& camera_from_station, double near_plane_m);
  RayHit cast(const Eigen::Vector3d& ray) const;
  /// Distance in px from a pixel to the nearest projected edge of any triangle, or to where the
  /// nearest surface changes in another way (near plane, intersection), found by probing: true when
  /// the hit is the same face all over a disc of this radius.
  bool sameFaceAround(const Camera& camera, const Eigen::Vector2d& pixel, double radius_px,
                      int face) const;
  /// z of the face's plane along a ray.
  double planeDepth(int face, const Eigen::Vector3d& ray) const;

 private:
  struct Triangle {
    Eigen::Vector3d corner, edge1, edge2;
  };
  std::vector<Triangle> triangles_;
  double near_plane_m_;
};

}  // namespace boresight::testing
