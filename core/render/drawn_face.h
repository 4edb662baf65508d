// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/render/camera_scene.h"

namespace boresight {

/// A face ready to be drawn.
struct DrawnFace {
  double a[3], b[3], c[3];  ///< edge i: a x/z + (b y/z + c)
  double limit[3];          ///< inside when the edge's value reaches this
  double slack[3];          ///< largest deviation of an edge's value from linear in a chunk's row
  double plane_x, plane_y, plane_1;  ///< 1/z = plane_x x/z + plane_y y/z + plane_1
  bool clamped;       ///< 1/z must be clamped to [low, high] and cut at the near plane
  double low, high;   ///< range of 1/z over the face
  double nearest;     ///< 1/z of the near plane
  std::int32_t face;  ///< index in the mesh

  /// Keeps 1/z within the face; false where the near plane cuts the face off.
  bool clamp(double& inverse_depth) const {
    if (inverse_depth > nearest && high > nearest) return false;
    inverse_depth = inverse_depth < low ? low : inverse_depth;
    inverse_depth = inverse_depth > high ? high : inverse_depth;
    return true;
  }
};

/// Sets up the edges, but for their `slack`. False when the face has no area seen from the camera.
[[nodiscard]] bool prepareEdges(const Corners& corners, DrawnFace& drawn);
/// Sets up all other members. False when the face is invisible or has no area.
[[nodiscard]] bool preparePlane(const Corners& corners, std::int32_t face, DrawnFace& drawn);
/// prepareEdges() and preparePlane(). False when the face is invisible.
[[nodiscard]] bool prepareFace(const CameraScene& scene, std::int32_t face, DrawnFace& drawn);

/// Whether a ray passes inside all three edges. Rows of the rasterizer compute the same terms in
/// the same order.
[[nodiscard]] inline bool insideFace(const DrawnFace& drawn, double ray_x, double ray_y) {
  for (int i = 0; i < 3; ++i)
    if (!(drawn.a[i] * ray_x + (drawn.b[i] * ray_y + drawn.c[i]) >= drawn.limit[i])) return false;
  return true;
}

/// 1/z where the ray meets the face's plane, rounded as for comparisons; false where the near plane
/// cuts the face off.
[[nodiscard]] inline bool inverseDepthOn(const DrawnFace& drawn, double ray_x, double ray_y,
                                         float& inverse_depth) {
  double value = drawn.plane_x * ray_x + (drawn.plane_y * ray_y + drawn.plane_1);
  if (drawn.clamped && !drawn.clamp(value)) return false;
  inverse_depth = static_cast<float>(value);
  return true;
}

}  // namespace boresight
