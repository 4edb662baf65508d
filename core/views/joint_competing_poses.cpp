// SPDX-License-Identifier: Apache-2.0
#include "core/views/joint_competing_poses.h"

#include <algorithm>

#include "core/localizer/pose_change.h"

namespace boresight {
namespace {

/// Share of the distance to the pose found within which two poses are the same.
constexpr double kSamePose = 0.25;

/// The view's mirror image of the pose found; nullptr when there is none.
const CompetingPose* mirrorImageIn(const CompetingPosesOfView& view) {
  const auto mirror = std::find_if(view.poses.begin(), view.poses.end(),
                                   [](const CompetingPose& pose) { return pose.mirrored; });
  return mirror == view.poses.end() ? nullptr : &*mirror;
}

/// The view's competing pose nearest to `camera_from_station`; nullptr when none is the same pose.
const CompetingPose* samePoseIn(const CompetingPosesOfView& view, const Pose& camera_from_station,
                                const Pose& found, const BoundingBox& scene) {
  double least_px =
      kSamePose * displacementBetween_px(found, camera_from_station, scene, *view.camera);
  const CompetingPose* nearest = nullptr;
  for (const CompetingPose& pose : view.poses) {
    if (pose.mirrored) continue;
    const double apart_px =
        displacementBetween_px(camera_from_station, pose.camera_from_station, scene, *view.camera);
    if (apart_px >= least_px) continue;
    least_px = apart_px;
    nearest = &pose;
  }
  return nearest;
}

}  // namespace

JointCompetingPoses jointCompetingPoses(std::span<const CompetingPosesOfView> views,
                                        const Pose& first_from_station, const BoundingBox& scene) {
  JointCompetingPoses joint;
  if (views.empty()) return joint;
  const CompetingPosesOfView& leading = views.front();
  for (const CompetingPose& named : leading.poses) {
    CompetingPose sum = named;
    sum.camera_from_station = leading.camera_from_first.inverse() * named.camera_from_station;
    const bool everywhere = std::all_of(views.begin() + 1, views.end(), [&](const auto& view) {
      const CompetingPose* same =
          sum.mirrored ? mirrorImageIn(view)
                       : samePoseIn(view, view.camera_from_first * sum.camera_from_station,
                                    view.camera_from_first * first_from_station, scene);
      if (same == nullptr) return false;
      sum.margin_nats += same->margin_nats;
      sum.similarity = std::min(sum.similarity, same->similarity);
      return true;
    });
    if (everywhere) joint.add(sum);
  }
  return joint;
}

}  // namespace boresight
