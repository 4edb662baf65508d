// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/accept/edge_support.h"
#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/workspace.h"
#include "core/pnp/pnp_view.h"
#include "core/views/joint_competing_poses.h"

namespace boresight {

inline constexpr int kMaxViews = kMaxPnpViews;

/// One image of the station: by a camera of a rigid rig, or by one camera at a known pose of its
/// arm (the rig is then any frame fixed to the station).
struct View {
  ImageView image;                   ///< 8-bit gray, of the camera's size
  const BitImage* ignore = nullptr;  ///< set bits are ignored; the image's size; may be nullptr
  Camera camera;                     ///< after prepareCamera
  /// The scene: the same in all views, but for the poses of parts that are fixed to the camera.
  MeshView mesh;
  Pose camera_from_rig;  ///< mounting of the camera
};

/// Several views of one station, solved for their common pose. The caller owns all data, which must
/// outlive the run.
struct ViewsProblem {
  std::span<const View> views;  ///< 1 ... kMaxViews; the first is the reference
  Pose rig_from_station_seed;   ///< where the search begins
  /// Per axis of the *first* view's seed camera frame, pivot included.
  SeedUncertainty uncertainty;
  /// Fixed to the first camera; see LocalizationProblem.
  Eigen::Vector3d end_effector_in_camera_m = Eigen::Vector3d::Zero();
};

/// Result of a view.
struct ViewReport {
  /// kConverged: it took part in the pose. Otherwise the reason: kTooFewEdges, kTooFewTemplates or
  /// kTooFewMatches (its own stages), kPnpFailed (too few of its matches, or edges, agree with the
  /// pose of all), kNotSupported (dropped at the end). kRunning before the end.
  LocalizationStatus status = LocalizationStatus::kRunning;
  std::int32_t correspondences = 0;  ///< of the latest match iteration; 0 when left out of it
  std::int32_t inliers = 0;          ///< of those
  std::int32_t edges_used = 0;       ///< of the latest refinement
  double edges_rms_px = 0.0;         ///< weighted residual, of the latest refinement
  EdgeSupport support;               ///< of the final pose; empty when it was not measured
  double probability = 0.0;          ///< that the pose is correct, by this view; 0 without a search
  Pose camera_from_station;          ///< of this view

  /// Whether the view contributed to the pose.
  bool tookPart() const { return status == LocalizationStatus::kConverged; }
};

/// State of a run; the workspace of each view's pass has the rest.
struct ViewsResult {
  LocalizationStatus status = LocalizationStatus::kRunning;  ///< state of the run
  Status fault = Status::kOk;                                ///< with kFault: the reason
  Pose rig_from_station;                                     ///< the seed unless converged
  /// Over xi = (rotation rad, translation m), left perturbation, in the rig's frame.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t iterations = 0;              ///< of all attempts
  std::int32_t attempts = 1;                ///< begun so far
  std::array<ViewReport, kMaxViews> views;  ///< one per view
  /// Poses that compete with the pose found in every view that took part: rig_from_station, with
  /// margins summed over the views.
  JointCompetingPoses competing_poses;
};

}  // namespace boresight
