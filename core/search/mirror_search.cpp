// SPDX-License-Identifier: Apache-2.0
#include "core/search/mirror_search.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/geometry/surface_axes.h"

namespace boresight {
namespace {

// How far the mirror image may be from the reflected pose: shares of the object's size and of its
// depth, and a tilt.
constexpr double kMirrorLateral = 0.2;
constexpr double kMirrorDepth = 0.1;
constexpr double kTilt_rad = 15.0 * kDegree_rad;
constexpr double kMostTilt_rad = 60.0 * kDegree_rad;

/// The pose that shows, in front of the flipped camera, the mesh mirrored across the principal
/// plane that its flattest side is perpendicular to.
Pose mirroredPose(const Pose& camera_from_station, const SurfaceAxes& surface) {
  const Eigen::Vector3d flip(-1.0, 1.0, 1.0);
  const Eigen::Vector3d axis = surface.axes.col(1);
  const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2.0 * axis * axis.transpose();
  // Two reflections: a rotation.
  const Eigen::Matrix3d rotation = flip.asDiagonal() * camera_from_station.matrix() * mirror;
  Pose pose;
  pose.rotation = Eigen::Quaterniond(rotation).normalized();
  pose.translation_m =
      flip.cwiseProduct(camera_from_station * surface.middle_m) - rotation * surface.middle_m;
  return pose;
}

/// Half a turn about the flattest side's normal is half a turn about the line of sight and a tilt
/// of twice the angle between the two.
double tiltOf(const Pose& camera_from_station, const SurfaceAxes& surface) {
  const Eigen::Vector3d normal = camera_from_station.matrix() * surface.axes.col(0);
  const Eigen::Vector3d sight = (camera_from_station * surface.middle_m).normalized();
  return std::min(kTilt_rad + 2.0 * asin(normal.cross(sight).norm()), kMostTilt_rad);
}

}  // namespace

SearchProblem mirrorSearch(const SearchProblem& problem, const Pose& camera_from_station) {
  const SurfaceAxes surface = surfaceAxesOf(problem.mesh);
  SearchProblem mirrored = problem;
  mirrored.flipped = true;
  mirrored.camera_from_station_seed = mirroredPose(camera_from_station, surface);
  const Eigen::Vector3d middle_m = mirrored.camera_from_station_seed * problem.scene.centre();
  const double lateral_m = kMirrorLateral * problem.scene.diagonal();
  mirrored.uncertainty.translation_m = {lateral_m, lateral_m, kMirrorDepth * middle_m.z()};
  const double tilt_rad = tiltOf(camera_from_station, surface);
  mirrored.uncertainty.rotation_rad = {tilt_rad, tilt_rad, kPi};
  mirrored.uncertainty.pivot_in_camera_m = middle_m;
  return mirrored;
}

}  // namespace boresight
