// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/annotation/mesh_snap.h"

namespace boresight::sessions {

/// A point on a visible salient edge of the model, and the half width of its band.
struct BandPlace {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< across the edge, unit length
  double half_width_px = 0.0;                         ///< 1.96 sigma: 95 % of poses are within
};

/// One visible part of an edge: points in order along it.
struct BandPiece {
  std::vector<BandPlace> places;
};

/// The 95 % band of the model's visible edges in the image under a pose's covariance (camera frame,
/// left perturbation, rotation rad and translation m): each point moves by J xi in the image; only
/// the component across the edge counts. Points are about `step_px` apart. The scene is rendered
/// once to find the visible edges; empty when it cannot be rendered.
std::vector<BandPiece> edgeBand(const MeshSnapper& mesh, const Camera& camera,
                                const Pose& camera_from_station, const Matrix6d& covariance,
                                double step_px = 12.0);

}  // namespace boresight::sessions
