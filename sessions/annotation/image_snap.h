// SPDX-License-Identifier: Apache-2.0
// Image features that an annotation may snap to, with sub-pixel accuracy. All functions work on the
// 8-bit image that the core uses. Several features are ordered by likelihood; the caller chooses.
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
/// has a maximum across it. Empty when no gradient within the radius exceeds 3 gray levels per
/// pixel.
std::optional<EdgeSnap> snapToEdge(const ImageView& image, const Eigen::Vector2d& near,
                                   double radius_px);

/// The corner nearby where edges in two directions meet, refined until the gradients around it are
/// perpendicular to their offsets from it (Foerstner; cv::cornerSubPix). A bent or noisy edge is
/// not a corner.
std::optional<Eigen::Vector2d> snapToCorner(const ImageView& image, const Eigen::Vector2d& near,
                                            double radius_px);

struct EllipseSnap {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_axes_px = Eigen::Vector2d::Zero();  ///< the longer one first
  double angle_rad = 0.0;                                  ///< of the longer one, from x towards y
  double support = 0.0;  ///< share of directions in which an edge lies on the ellipse
  double rms_px = 0.0;   ///< of these edges' distances from it
};
/// The ellipse around a position, such as that of a screw or hole: edges in all directions from it,
/// at most `radius_px` away. Its centre differs from that of the projected circle: at 20 radii and
/// 45 deg by about a hundredth of its size. Empty when fewer than 60 % of the directions agree.
std::optional<EllipseSnap> snapToEllipse(const ImageView& image, const Eigen::Vector2d& inside,
                                         double radius_px);

enum class ImageSnapKind { kCorner, kEllipse, kEdge };

/// An image feature that an annotation may snap to.
struct ImageSnap {
  ImageSnapKind kind = ImageSnapKind::kCorner;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double distance_px = 0.0;  ///< from the queried position
  EdgeSnap edge;             ///< of a kEdge
  EllipseSnap ellipse;       ///< of a kEllipse
};

/// Features within the radius of a position, the likeliest first. They are ordered by distance; an
/// edge, which is always nearer than the corner at its end, counts as half a radius farther. The
/// centre of an ellipse must lie within the radius, its rim within `rim_px` of the position.
std::vector<ImageSnap> imageSnaps(const ImageView& image, const Eigen::Vector2d& near,
                                  double radius_px, double rim_px);

/// Orders the result of MeshSnapper::near() by the same likelihood.
std::vector<MeshSnap> likeliestFirst(std::vector<MeshSnap> snaps, double radius_px);

}  // namespace boresight::sessions
