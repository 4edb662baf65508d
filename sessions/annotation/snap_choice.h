// SPDX-License-Identifier: Apache-2.0
// Which of several places near a pointer a person most likely means.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"
#include "sessions/annotation/image_snap.h"
#include "sessions/annotation/mesh_snap.h"

namespace boresight::sessions {

enum class ImageSnapKind { kCorner, kEllipse, kEdge };

/// A place of the image that a mark may snap to.
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
