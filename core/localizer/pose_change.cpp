// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/pose_change.h"

#include <algorithm>
#include <cmath>

namespace boresight {
namespace {

/// Offset, rad or m, by which rounding may move a pose along an axis that is known exactly.
constexpr double kRounding = 1e-7;

/// Half-widths of the uncertainty in the order of an offset: rotation, translation.
Vector6d limitsOf(const SeedUncertainty& uncertainty) {
  Vector6d limits;
  limits << uncertainty.rotation_rad, uncertainty.translation_m;
  return limits;
}

}  // namespace

double translationBetween_m(const Pose& before, const Pose& after, const RunContext& run) {
  switch (run.options.loop.correction_point) {
    case CorrectionPoint::kStation:
      return (after * run.scene.centre() - before * run.scene.centre()).norm();
    case CorrectionPoint::kEndEffector:
      return (after.inverse() * run.end_effector_in_camera_m -
              before.inverse() * run.end_effector_in_camera_m)
          .norm();
    case CorrectionPoint::kCamera:
      break;
  }
  return (after.inverse().translation_m - before.inverse().translation_m).norm();
}

double rotationBetween_rad(const Pose& before, const Pose& after) {
  return rotationLog((after.rotation * before.rotation.conjugate()).normalized()).norm();
}

double displacementBetween_px(const Pose& before, const Pose& after, const BoundingBox& scene,
                              const Camera& camera) {
  double sum_px = 0.0;
  int seen = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point_in_station_m = scene.corner(corner);
    Eigen::Vector2d from_px;
    Eigen::Vector2d to_px;
    if (!project(camera, before * point_in_station_m, from_px)) continue;
    if (!project(camera, after * point_in_station_m, to_px)) continue;
    sum_px += (to_px - from_px).norm();
    ++seen;
  }
  return seen > 0 ? sum_px / seen : 1e6;
}

bool isKnownPose(const Pose& camera_from_station, std::span<const PoseHypothesis> known,
                 double nearer_px, const BoundingBox& scene, const Camera& camera) {
  return std::any_of(known.begin(), known.end(), [&](const PoseHypothesis& hypothesis) {
    return displacementBetween_px(hypothesis.camera_from_station, camera_from_station, scene,
                                  camera) < nearer_px;
  });
}

double longerSide_px(const Pose& camera_from_station, const BoundingBox& scene,
                     const Camera& camera) {
  Eigen::AlignedBox2d box;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector2d pixel;
    if (project(camera, camera_from_station * scene.corner(corner), pixel)) box.extend(pixel);
  }
  const Eigen::AlignedBox2d image(Eigen::Vector2d::Zero(),
                                  Eigen::Vector2d(camera.width, camera.height));
  const Eigen::AlignedBox2d seen = box.intersection(image);
  return seen.isEmpty() ? 0.0 : seen.sizes().maxCoeff();
}

bool areDistinct(const Pose& first, const Pose& second, const BoundingBox& scene,
                 const Camera& camera) {
  constexpr double kOfLongerSide = 0.03;
  constexpr double kLeast_px = 2.0;
  return displacementBetween_px(first, second, scene, camera) >
         std::max(kLeast_px, kOfLongerSide * longerSide_px(first, scene, camera));
}

bool areDistinct(const Pose& first, const EdgePlaces& first_edges, const Pose& second,
                 const BoundingBox& scene, const Camera& camera) {
  constexpr double kOfLongerSide = 0.015;
  constexpr double kLeast_px = 1.0;
  constexpr double kFewPlaces = 2.0;  // factor on the motion that few places may show
  const std::optional<EdgePlaces::Motion> motion = first_edges.motionTo(second);
  if (!motion) return areDistinct(first, second, scene, camera);
  const double limit_px = std::max(kLeast_px, kOfLongerSide * longerSide_px(first, scene, camera));
  return motion->quantile_px > limit_px || motion->rms_px > kFewPlaces * limit_px;
}

double motionWithin_px(const Seed& seed, const BoundingBox& scene, const Camera& camera) {
  const Vector6d limits = limitsOf(seed.uncertainty);
  double squared_px = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    const Pose displaced =
        displacedAboutPivot(seed.camera_from_station, Vector6d::Unit(axis) * limits[axis],
                            seed.uncertainty.pivot_in_camera_m);
    const double motion_px =
        displacementBetween_px(seed.camera_from_station, displaced, scene, camera);
    squared_px += motion_px * motion_px;
  }
  return std::sqrt(squared_px);
}

Pose rolledAboutScene(const Pose& camera_from_station, double roll_rad, const BoundingBox& scene) {
  const Eigen::Vector3d axis = (camera_from_station * scene.centre()).normalized();
  const Eigen::Quaterniond turn = rotationExp(axis * roll_rad);
  Pose rolled;
  rolled.rotation = (turn * camera_from_station.rotation).normalized();
  rolled.translation_m = turn * camera_from_station.translation_m;
  return rolled;
}

bool leftUncertainty(const Seed& seed, const Pose& camera_from_station, double factor) {
  const Vector6d offset = offsetAboutPivot(seed.camera_from_station, camera_from_station,
                                           seed.uncertainty.pivot_in_camera_m);
  const Vector6d limits = limitsOf(seed.uncertainty);
  for (int i = 0; i < 6; ++i)
    if (std::abs(offset[i]) > factor * limits[i] + kRounding) return true;
  return false;
}

Pose pulledBack(const Seed& seed, const Pose& camera_from_station) {
  const Eigen::Vector3d& pivot_in_camera_m = seed.uncertainty.pivot_in_camera_m;
  Vector6d offset =
      offsetAboutPivot(seed.camera_from_station, camera_from_station, pivot_in_camera_m);
  const Vector6d limits = limitsOf(seed.uncertainty);
  bool outside = false;
  for (int i = 0; i < 6; ++i) {
    outside = outside || std::abs(offset[i]) > limits[i];
    offset[i] = std::clamp(offset[i], -limits[i], limits[i]);
  }
  if (!outside) return camera_from_station;
  return displacedAboutPivot(seed.camera_from_station, offset, pivot_in_camera_m);
}

void measureCorrection(const Pose& before, const Pose& after, const RunContext& run,
                       Iteration& iteration) {
  iteration.correction_translation_m = translationBetween_m(before, after, run);
  iteration.correction_image_px = displacementBetween_px(before, after, run.scene, run.camera);
  iteration.correction_rotation_rad = rotationBetween_rad(before, after);
}

}  // namespace boresight
