// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tests/core/render/scenes.h"

namespace boresight::testing {

/// The image of a straight line in space, through the camera's full model.
class ProjectedLine {
 public:
  /// The line begin + s * direction, s in [s_first, s_last], camera frame.
  ProjectedLine(const Camera& camera, const Eigen::Vector3d& begin,
                const Eigen::Vector3d& direction, double s_first, double s_last);
  /// Signed distance in px; positive on the right of the direction of travel (image axes, y down).
  /// `normal` points to that side.
  double signedDistance(const Eigen::Vector2d& pixel, Eigen::Vector2d& normal) const;

 private:
  std::vector<Eigen::Vector2d> points_;
};

/// What the edge pixels of a render say about one line.
struct LineStatistics {
  int pixels = 0;
  double mean_px = 0.0;          ///< signed distance of centres to the line
  double largest_px = 0.0;       ///< its largest magnitude
  double largest_excess_px = 0;  ///< |distance| - 0.5 max(|cos|, |sin|), the largest
  double offset_error_px = 0.0;  ///< recorded against true distance along the recorded normal
  double normal_error = 0.0;     ///< recorded against true normal, up to sign
  int doubled = 0;               ///< rows (steep lines) or columns with more than one pixel
  int missing = 0;               ///< rows or columns between the first and the last with none
};

/// Edge pixels at least `margin_px` within the image against a line that crosses it.
LineStatistics lineStatistics(const EdgeRender& render, const ProjectedLine& line, int margin_px);

}  // namespace boresight::testing
