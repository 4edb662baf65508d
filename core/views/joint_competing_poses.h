// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/fixed_list.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/search/competing_poses.h"

namespace boresight {

/// Competing poses that the image of one view leaves, and the mounting of that view.
struct CompetingPosesOfView {
  std::span<const CompetingPose> poses;  ///< in the view's camera frame
  Pose camera_from_first;                ///< view's camera from the first view's camera
  const Camera* camera = nullptr;        ///< of the view
};

/// Poses that compete in every view.
using JointCompetingPoses = FixedList<CompetingPose, CompetingPoseTest::kMostPoses>;

/// The poses that compete in every view, in the first view's camera frame: a view in whose image a
/// pose does not compete excludes it. Margins are sums over the views; the similarity is the
/// smallest of the views. `first_from_station`: the pose found; `scene`: station frame. Poses of
/// two views count as the same when the scene's corners differ in the image by less than a quarter
/// of their distance from the pose found; so do mirror images of the mesh.
JointCompetingPoses jointCompetingPoses(std::span<const CompetingPosesOfView> views,
                                        const Pose& first_from_station, const BoundingBox& scene);

}  // namespace boresight
