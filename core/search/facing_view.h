// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/edges/directed_edges.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/search/search_problem.h"

namespace boresight {

/// A small pinhole camera at the position of the real camera, facing the centre of the scene. Its
/// image has no distortion, the object is small, and a turn of the camera shifts the image. Cameras
/// whose rays start at several places (CAHVORE) are taken as if all rays started at the camera's
/// centre.
struct FacingView {
  Camera camera;               ///< pinhole, prepared
  Pose view_from_camera;       ///< a rotation
  double pixels_per_px = 1.0;  ///< view pixels per pixel of the real image, at most 2
  double span_px = 0.0;        ///< longer side of the visible object, px of the view
};

/// Usual margin around the object, of its size.
inline constexpr double kViewMargin = 0.1;

/// Requested size of a view.
struct ViewSize {
  double span_px = 0.0;     ///< longer side of the visible object, at most 2 px per real px
  double margin_px = 0.0;   ///< around the object
  double slide_x = 0.0;     ///< range of the object's motion to either side, as tangents
  double slide_y = 0.0;     ///< the same, downwards
  double least_half = 0.0;  ///< least half of the object's longer side, as a tangent
  int most_px = 0;          ///< longest side of the image
};

/// The shortest rotation that brings the ray through a point to the z axis.
Pose viewTowards(const Eigen::Vector3d& point_in_camera_m);

/// The view of the scene at a pose. False when the scene is behind the camera or out of sight.
[[nodiscard]] bool faceScene(const SearchProblem& problem, const Pose& camera_from_station,
                             const ViewSize& size, FacingView& view);

/// Channels of the image in which edges are detected: colour, or gray.
inline int channelsOf(const SearchProblem& problem) {
  return problem.color.data != nullptr ? ColorView::kChannels : 1;
}

/// Fills rows `first` ... `end - 1` of the view's image, all its channels: the mean of the real
/// image over the area of each pixel. Pixels outside the real image, and ignored ones, are not
/// known.
void fillViewRows(const SearchProblem& problem, const FacingView& view, int first, int end,
                  SmallImage& output);

}  // namespace boresight
