// SPDX-License-Identifier: Apache-2.0
// Quality of an image for localization, measured without a run.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/problem.h"

namespace boresight::sessions {

/// Quality of the pixels of a region that are not ignored.
struct ImageQuality {
  /// One sigma, gray levels: median absolute response of the Laplacian difference kernel of
  /// Immerkaer (1996) at pixels that are neither black nor saturated.
  double noise_gray = 0.0;
  double contrast_gray = 0.0;    ///< standard deviation, gray levels (RMS contrast)
  double range_gray = 0.0;       ///< between the 1st and the 99th percentile, gray levels
  double saturated_share = 0.0;  ///< of the pixels, at the largest gray level
  double black_share = 0.0;      ///< of the pixels, at gray level 0
  /// Width of the strongest edges in the direction in which they are widest (EdgeWidth): motion and
  /// defocus. 0: too few edges.
  double edge_width_px = 0.0;
};

/// The figures by their names in files.
inline constexpr std::pair<const char*, double ImageQuality::*> kImageQualityParts[] = {
    {"noise_gray", &ImageQuality::noise_gray},
    {"contrast_gray", &ImageQuality::contrast_gray},
    {"range_gray", &ImageQuality::range_gray},
    {"saturated_share", &ImageQuality::saturated_share},
    {"black_share", &ImageQuality::black_share},
    {"image_edge_width_px", &ImageQuality::edge_width_px}};

/// Pixels of an image, both corners included.
using PixelRegion = Eigen::AlignedBox2i;

/// The bounding box of the matched parts' projection, within the image.
PixelRegion stationRegion(const Camera& camera, const MeshView& mesh,
                          const Pose& camera_from_station);

/// Empty when the region has no pixel that is not ignored. `ignore` may be nullptr.
std::optional<ImageQuality> measureImageQuality(const ImageView& image, const BitImage* ignore,
                                                const PixelRegion& region);

/// Quality of the region where the station appears at the problem's seed.
std::optional<ImageQuality> imageQualityOf(const LocalizationProblem& problem);

/// "noise 1.2 gray, contrast 41 gray (range 180), 0.3 % saturated, 0.0 % black, edges 3.1 px wide".
std::string imageQualityText(const std::optional<ImageQuality>& quality);

}  // namespace boresight::sessions
