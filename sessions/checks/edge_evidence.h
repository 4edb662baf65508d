// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/evaluation/model_error.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Edge of the raw image found across a predicted line.
struct FoundEdge {
  double offset_px = 0.0;  ///< along the normal, from the predicted place
  double slope = 0.0;      ///< size of the derivative there, gray/px
};

/// Gradient of the raw image at its own scale (OpenCV's Gaussian and Scharr, independent of the
/// localization's filters), with two queries: the edge of a given direction at a position, and all
/// edges of a region.
class ImageEdges {
 public:
  /// Gradients of a region, which is cut to the image; ignored pixels (`ignore` may be nullptr)
  /// show no edge. All data is copied: the image need not outlive the object.
  ImageEdges(const ImageView& image, const BitImage* ignore, const cv::Rect& region);

  const cv::Rect& region() const { return region_; }
  /// Whether a pixel of the region is ignored.
  bool isIgnored(const cv::Point& pixel) const { return ignored_(pixel - region_.tl()) != 0; }
  /// Gray per px; the pixel must lie in the region.
  Eigen::Vector2d gradient(const cv::Point& pixel) const {
    const cv::Point at = pixel - region_.tl();
    return {static_cast<double>(dx_(at)), static_cast<double>(dy_(at))};
  }

  /// The steepest place along a line's normal within the radius whose gradient points along the
  /// normal, either way, to 25 deg; to a fraction of a pixel by a parabola. Empty when no slope
  /// reaches `least_slope` (gray/px), or the profile leaves the region or meets ignored pixels.
  std::optional<FoundEdge> across(const Eigen::Vector2d& predicted_px,
                                  const Eigen::Vector2d& normal, double radius_px,
                                  double least_slope) const;
  /// Whether across() can search there: inside the region, not on an ignored pixel.
  bool canLook(const Eigen::Vector2d& predicted_px, double radius_px) const;

  /// Thin edges of the region (Canny 1986 with hysteresis down to half the slope): nonzero on an
  /// edge.
  cv::Mat1b thinEdges(double least_slope) const;

 private:
  Eigen::Vector2d between(const Eigen::Vector2d& pixel) const;

  cv::Rect region_;
  cv::Mat1f dx_;  ///< gray/px
  cv::Mat1f dy_;
  cv::Mat1b ignored_;
};

/// A piece of an edge that a pose predicts to be seen, in one pixel.
struct EdgePlace {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();   ///< on the line, sub-pixel
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the line, unit
  double length_px = 1.0;  ///< of the line that the pixel represents: up to sqrt(2) on a diagonal
  std::uint8_t kind = 0;   ///< EdgeKind bits
};

/// The station's visible edges at full resolution, in raster order.
struct PredictedEdges {
  std::vector<EdgePlace> places;
  BitMap mask;  ///< the station's silhouette with its edges
};

/// Empty when the scene cannot be rendered from this pose. Throws std::bad_alloc.
PredictedEdges predictEdges(const Camera& camera, const MeshView& mesh,
                            const Pose& camera_from_station);

/// Derivative of a projected point by the camera: px per px of focal length (fy with fx), cx, cy.
Eigen::Matrix<double, 2, 3> pixelByCamera(const Camera& camera, const Eigen::Vector2d& pixel);

/// At most `most` places, evenly spaced in their order.
std::vector<EdgePlace> thinned(const std::vector<EdgePlace>& places, std::size_t most);

/// How the image's edges are searched.
///@{
inline constexpr double kEdgeRadius_px = 4.0;     ///< search radius along the normal
inline constexpr double kNearEdge_px = 1.5;       ///< largest distance from the predicted edge
inline constexpr double kLeastSlope = 1.5;        ///< gray/px
inline constexpr double kDisplaced_px = 4.0;      ///< displacement for FallOff, rms in the image
inline constexpr std::size_t kEdgePlaces = 6000;  ///< at most: enough for a share to a percent
///@}

/// A share as numerator and denominator.
struct Share {
  double part = 0.0;
  double whole = 0.0;

  double value() const { return whole > 0.0 ? part / whole : 0.0; }
};

/// Edge-coverage sensitivity: coverage after a displacement of the pose in one direction.
struct FallOff {
  std::string direction;  ///< for display: "turned about the view axis"
  double coverage = 0.0;  ///< with the pose displaced this way, the mean of both senses
};

/// A predicted edge point and the edge found there.
struct LookedPlace {
  EdgePlace place;
  std::optional<FoundEdge> found;
};

/// Searches the image at all places that can be searched, in their order.
std::vector<LookedPlace> lookAt(const ImageEdges& image, const std::vector<EdgePlace>& places);
/// Predicted length with an image edge nearby, of the length searched.
Share coverageOf(const std::vector<LookedPlace>& looked);

/// Coverage of the station at a pose, rendered again; an empty share when no edge can be searched.
Share coverageOfPose(const LoadedCase& loaded, const Pose& camera_from_station);

/// Share of image edges without a predicted edge of their direction within 2 px, among those inside
/// the silhouette that are at least half as steep as the predicted edges found.
Share clutterOf(const ImageEdges& image, const PredictedEdges& edges,
                const std::vector<LookedPlace>& looked);

/// Evidence beyond chance, as a share of that expected at a correct pose: log of the odds that an
/// edge is seen at a correct pose and where the outline is displaced by a twentieth and a tenth of
/// its size (16 ways), summed over at most 1500 places. Negative: fewer edges than by chance.
Share evidenceOf(const ImageEdges& image, const std::vector<LookedPlace>& looked);

/// The region in which a pose's edges are searched, including displaced ones.
cv::Rect regionOf(const PredictedEdges& edges);

/// Coverage with the pose displaced along the six axes at the station and in the least determined
/// direction, without the part along `symmetric` motions: an axis of little else is left out.
std::vector<FallOff> fallOffOf(const ImageEdges& image, const std::vector<EdgePlace>& places,
                               const Camera& camera, const Pose& camera_from_station,
                               const PoseMotions& symmetric = PoseMotions(6, 0));

}  // namespace boresight::sessions
