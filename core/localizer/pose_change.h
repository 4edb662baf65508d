// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/pose_hypothesis.h"
#include "core/localizer/problem.h"
#include "core/refine/edge_places.h"

// Distances between two poses for the convergence test.
namespace boresight {

/// Distance between the poses at loop.correction_point: of the camera's centre or the end effector
/// in the station frame, or of the scene's middle in the camera frame.
double translationBetween_m(const Pose& before, const Pose& after, const RunContext& run);
/// Angle between the poses, [0, pi].
double rotationBetween_rad(const Pose& before, const Pose& after);
/// Mean displacement of the corners of the scene's box in the image; 1e6 when none is seen from
/// both poses.
double displacementBetween_px(const Pose& before, const Pose& after, const BoundingBox& scene,
                              const Camera& camera);
/// Longer side of the bounding box of the scene's corners, clipped to the image; 0 when no corner
/// is seen.
double longerSide_px(const Pose& camera_from_station, const BoundingBox& scene,
                     const Camera& camera);
/// Whether the poses are distinct solutions: farther apart in the image than 3 % of the object's
/// longer side and than 2 px.
bool areDistinct(const Pose& first, const Pose& second, const BoundingBox& scene,
                 const Camera& camera);
/// The same by the motion of the first pose's edges along their normals, 1.5 % of the longer side
/// and 1 px for a fifth of them, or twice that in root mean square: poses that differ only by what
/// the edges do not show are one. By the scene's corners where there are too few edges.
bool areDistinct(const Pose& first, const EdgePlaces& first_edges, const Pose& second,
                 const BoundingBox& scene, const Camera& camera);

/// Whether the pose is nearer than `nearer_px` to one of the hypotheses.
bool isKnownPose(const Pose& camera_from_station, std::span<const PoseHypothesis> known,
                 double nearer_px, const BoundingBox& scene, const Camera& camera);

/// Displacement of the scene's box in the image at the limits of the seed's uncertainty: root of
/// the sum of squares over the axes.
double motionWithin_px(const Seed& seed, const BoundingBox& scene, const Camera& camera);

/// The pose turned about the ray through the scene's middle, so that the scene stays where it is.
Pose rolledAboutScene(const Pose& camera_from_station, double roll_rad, const BoundingBox& scene);

/// Whether the pose lies outside the seed's uncertainty, `factor` times as large.
bool leftUncertainty(const Seed& seed, const Pose& camera_from_station, double factor);
/// The nearest pose inside the seed's uncertainty, axis by axis: a coarse estimate may overshoot in
/// directions that the image constrains weakly.
Pose pulledBack(const Seed& seed, const Pose& camera_from_station);

/// Fills in the corrections of an iteration that moved a pose.
void measureCorrection(const Pose& before, const Pose& after, const RunContext& run,
                       Iteration& iteration);

}  // namespace boresight
