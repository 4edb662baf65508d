// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

/// Pixels of a level where the centre of a template may lie, bounds included.
struct SearchWindow {
  int x_min = 0, y_min = 0, x_max = -1, y_max = -1;  ///< px of the level
  /// Whether it holds no pixel.
  bool empty() const { return x_max < x_min || y_max < y_min; }
  /// Whether a pixel lies on its border, or beyond.
  bool endsAt(int x, int y) const { return x <= x_min || x >= x_max || y <= y_min || y >= y_max; }
  /// Whether a position lies in it.
  bool contains(double x, double y) const {
    return x >= x_min && x <= x_max && y >= y_min && y <= y_max;
  }
  /// px.
  int width() const { return x_max - x_min + 1; }
  /// px.
  int height() const { return y_max - y_min + 1; }
};

/// Pixels where a point of the hypothesis can appear when the pose moves within `uncertainty` (Pham
/// 2025, Sec. III-A): a rectangle that contains the projection of Exp(r)(p - c) + c + t for every
/// |r_i| <= rotation_rad[i], |t_i| <= translation_m[i]. Conservative by construction (bounds of the
/// rotation's Taylor terms), clipped to centres whose template of side `template_side_px` lies
/// inside the image; empty when none does, or when the point may lie behind the camera.
SearchWindow searchWindow(const Camera& camera, const Eigen::Vector3d& point_in_camera_m,
                          const SeedUncertainty& uncertainty, int template_side_px);

}  // namespace boresight
