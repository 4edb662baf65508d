// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/edges/directed_edges.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/search/search_problem.h"

namespace boresight {

/// A small pinhole camera at the place of the real one that looks at the middle of the scene. In
/// its image there is no distortion, the object is small, and a turn of the camera shifts what is
/// seen. Cameras whose rays start at several places (CAHVORE) are taken as if all rays started at
/// the camera's centre.
struct FacingView {
  Camera camera;               ///< pinhole, prepared
  Pose view_from_camera;       ///< a rotation
  double pixels_per_px = 1.0;  ///< view pixels per pixel of the real image, at most 1
  double span_px = 0.0;        ///< longer side of the visible object, px of the view
};

/// How large a view is asked for.
struct ViewSize {
  double span_px = 0.0;  ///< longer side of the visible object; less where the real image has less
  double margin_px = 0.0;   ///< around the object
  double slide_x = 0.0;     ///< how far the object may move, as tangents
  double slide_y = 0.0;     ///< the same, downwards
  double least_half = 0.0;  ///< half of the object's longer side is taken as this at least, tangent
  int most_px = 0;          ///< longest side of the image
};

/// The shortest rotation that brings the ray through a point to the z axis.
Pose viewTowards(const Eigen::Vector3d& point_in_camera_m);

/// The view of the scene at a pose. False when the scene is behind the camera or out of sight.
[[nodiscard]] bool faceScene(const SearchProblem& problem, const Pose& camera_from_station,
                             const ViewSize& size, FacingView& view);

/// Channels of the image that edges are looked for in: those of its colour, or its gray.
inline int channelsOf(const SearchProblem& problem) {
  return problem.color.data != nullptr ? ColorView::kChannels : 1;
}

/// Fills rows `first` ... `end - 1` of the view's image, all its channels: the mean of the real
/// image over what each pixel covers. Pixels outside the real image, and ignored ones, are not
/// known.
void fillViewRows(const SearchProblem& problem, const FacingView& view, int first, int end,
                  SmallImage& output);

}  // namespace boresight
