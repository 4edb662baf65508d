// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/annotation/mesh_snap.h"

namespace boresight::sessions {

/// A place on a seen salient edge of the model and how far across it the edge may lie.
struct BandPlace {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< across the edge, unit length
  double half_width_px = 0.0;                         ///< 1.96 sigma: 95 % of poses are within
};

/// One seen piece of an edge: places in order along it.
struct BandPiece {
  std::vector<BandPlace> places;
};

/// The 95 % band of the model's seen edges on the image under a pose's covariance (camera frame,
/// left perturbation, rotation rad and translation m): each place's image moves by J xi, and what
/// counts is its part across the edge. Places are about `step_px` apart. The scene is rendered once
/// to tell what is seen; nothing comes out where it cannot be.
std::vector<BandPiece> edgeBand(const MeshSnapper& mesh, const Camera& camera,
                                const Pose& camera_from_station, const Matrix6d& covariance,
                                double step_px = 12.0);

}  // namespace boresight::sessions
