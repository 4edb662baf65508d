// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_view.h"

namespace boresight {

/// Minimizes
///     sum over used i of (|pixel_i - project(camera_from_station * point_i)| / sigma_i)^2
///     + the prior's sum over its six axes of (offset about the pivot / sigma)^2
/// from the given pose over the correspondences of all views, with the full camera model; the pose
/// and the prior are the first view's: Gauss-Newton steps, damped (Levenberg-Marquardt
/// on the diagonal) while a step would not lower the sum. At most `max_iterations` steps are tried.
/// `use`: empty (all), or one per correspondence, nonzero = used; correspondences that are not
/// usable are left out. `prior` may be nullptr.
///
/// kTooFewPoints: `use` has another length. kInvalidPose: the pose or the prior is not usable.
/// kDegenerate: without a prior fewer than three points project, or the normal equations are
/// singular (a pivot below 1e-12, as in `solve`). The pose is then left as it was; otherwise it is
/// finite, and its sum is not above the initial one (but for rounding).
Status refinePose(std::span<const Correspondence> correspondences,
                  std::span<const std::uint8_t> use, std::span<const PnpView> views,
                  const PosePrior* prior, int max_iterations, Pose& first_from_station);

/// Covariance over xi = (rotation rad, translation m) of the left perturbation of the first view's
/// pose, camera frame, at a pose from the used correspondences: s^2 (J' W J)^-1 with W =
/// 1/sigma_px^2 and the observed variance s^2 = sum (residual / sigma)^2 / (2 n - 6), at least
/// 1e-12 and with a denominator of at least 1. A factor common to all sigmas cancels. kDegenerate
/// when fewer than three points project or J' W J is singular; kTooFewPoints, kInvalidPose as in
/// refinePose.
Status poseCovariance(std::span<const Correspondence> correspondences,
                      std::span<const std::uint8_t> use, std::span<const PnpView> views,
                      const Pose& first_from_station, Matrix6d& covariance);

}  // namespace boresight
