// SPDX-License-Identifier: Apache-2.0
// Places in an image that an annotation may snap to, to a fraction of a pixel. All of them work on
// the 8-bit image as the core sees it and leave the choice to the caller. Which of several places
// near a pointer a person most likely means.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"
#include "sessions/annotation/mesh_snap.h"

namespace boresight::sessions {

struct EdgeSnap {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal =
      Eigen::Vector2d::UnitX();  ///< across the edge, towards the brighter side
  double contrast = 0.0;         ///< gray levels per pixel
};
/// The nearest step between dark and bright: where the gradient of the smoothed image (sigma 1 px)
/// has a maximum across it. Nothing within the radius is steeper than 3 gray levels per pixel:
/// nothing.
std::optional<EdgeSnap> snapToEdge(const ImageView& image, const Eigen::Vector2d& near,
                                   double radius_px);

/// The corner nearby where edges in two directions meet, refined until every gradient around it
/// points past it (Foerstner; cv::cornerSubPix). An edge that only bends, or a noisy one, is none.
std::optional<Eigen::Vector2d> snapToCorner(const ImageView& image, const Eigen::Vector2d& near,
                                            double radius_px);

struct EllipseSnap {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_axes_px = Eigen::Vector2d::Zero();  ///< the longer one first
  double angle_rad = 0.0;                                  ///< of the longer one, from x towards y
  double support = 0.0;  ///< share of directions in which an edge lies on the ellipse
  double rms_px = 0.0;   ///< of these edges' distances from it
};
/// The ellipse around a place, as screws and holes have one: edges in all directions from there,
/// at most `radius_px` away. The centre of an ellipse is not quite that of the circle that it
/// shows: at a distance of 20 radii and 45 deg by some hundredth of its size. Nothing when fewer
/// than 60 % of the directions agree.
std::optional<EllipseSnap> snapToEllipse(const ImageView& image, const Eigen::Vector2d& inside,
                                         double radius_px);

enum class ImageSnapKind { kCorner, kEllipse, kEdge };

/// A place of the image that an annotation may snap to.
struct ImageSnap {
  ImageSnapKind kind = ImageSnapKind::kCorner;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double distance_px = 0.0;  ///< from the place that was asked about
  EdgeSnap edge;             ///< of a kEdge
  EllipseSnap ellipse;       ///< of a kEllipse
};

/// What there is within the radius of a place, the likeliest first: distance decides, but an edge,
/// which is always nearer than the corner at its end, counts as half a radius farther. Of an
/// ellipse the centre must lie within the radius, its rim within `rim_px` of the place.
std::vector<ImageSnap> imageSnaps(const ImageView& image, const Eigen::Vector2d& near,
                                  double radius_px, double rim_px);

/// What `MeshSnapper::near` gives, in the same order of likelihood.
std::vector<MeshSnap> likeliestFirst(std::vector<MeshSnap> snaps, double radius_px);

}  // namespace boresight::sessions
