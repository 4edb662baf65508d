// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/review/edge_evidence.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// What the image's edges say of the final pose, measured anew and not by the run's own gate:
/// coverage, clutter and fall-off kept apart, and whether they ask for another camera.
void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks);

/// What the edges say of the camera when its focal length and principal point are left free
/// together with the pose.
struct CameraFit {
  double focal_px = 0.0;   ///< change of the focal length that the edges ask for
  double centre_px = 0.0;  ///< length of the principal point's change
  double focal_sigma_px = 0.0;
  double centre_sigma_px = 0.0;  ///< along the change
};

/// Least squares over the distances along the normals with Tukey's weights, linear about the pose.
/// The sigmas allow for edges that are off together (a bevel, a shadow): square tiles of the image
/// count as one observation each (cluster-robust covariance, Liang and Zeger 1986). Nothing with
/// fewer than 60 edges found or when these do not determine all nine.
std::optional<CameraFit> fitCamera(std::span<const LookedPlace> looked, const Camera& camera,
                                   const Pose& camera_from_station);

}  // namespace boresight::sessions
