// SPDX-License-Identifier: Apache-2.0
// Pictures made worse in stated ways, the same way each time.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/base/random.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::test {

/// What a kind does, and the strengths that are tried.
struct DegradationKind {
  std::string name;
  std::string strength;  ///< what the number is
  std::vector<double> tried;
  /// Changes a gray picture of an object; the generator decides places and directions.
  void (*apply)(double strength, const cv::Mat& silhouette, Random& random, cv::Mat& picture);
};

/// In the order of the table:
/// - gray_patch, texture_patch, cables: so much of the object's silhouette is covered, by a gray
///   ellipse, by an ellipse that shows another place of the picture, by dark straight bands;
/// - straight_shadow, curved_shadow: so much light is left beyond a line, or within a disc;
/// - overexposed: so much of the silhouette is saturated, and its light spreads;
/// - contrast: so much of the differences to the silhouette's mean is left;
/// - dust: a veil and specks, graded 0 ... 1;
/// - motion, defocus: length of the line and radius of the disc that a point becomes, px;
/// - dead_columns, hot_pixels, row_noise: columns; share of pixels; standard deviation, gray;
/// - noise: standard deviation, gray; jpeg: 100 - quality.
/// Lengths are those of a picture 2048 px wide, and shrink with it.
const std::vector<DegradationKind>& degradationKinds();

/// Pixels within the projection of the mesh's faces.
cv::Mat silhouette(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station);

}  // namespace boresight::test
