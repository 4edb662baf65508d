// SPDX-License-Identifier: Apache-2.0
// Data for pictures of an iteration that its record does not hold; pixels are of the full image.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Where render and image agree, at the render's level.
struct AgreementMaps {
  BitMap both;           ///< rendered edge pixels with a test edge within one pixel
  BitMap only_rendered;  ///< rendered edge pixels without
  BitMap only_image;  ///< test edges on the rendered mask without a rendered edge within one pixel
};

/// Maps of different sizes give empty ones.
AgreementMaps agreementOf(const RenderTrace& render, const BitMap& test_edges);

/// Residual of the pose after an iteration: where the 3D point projects and where it was found.
struct ResidualVector {
  int template_index = -1;  ///< -1: a place on an edge, of a refinement
  Eigen::Vector2d projected = Eigen::Vector2d::Zero();
  Eigen::Vector2d found = Eigen::Vector2d::Zero();
  bool inlier = false;  ///< or weighted above one half
};
/// `camera` is that of the full image. Points that do not project are left out.
std::vector<ResidualVector> residualVectors(const IterationTrace& iteration, const Camera& camera);

}  // namespace boresight::sessions
