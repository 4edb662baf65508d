// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/first_pose.h"

#include <algorithm>
#include <cstddef>

#include "core/pnp/pnp.h"
#include "sessions/annotation/geometry_meter.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kFewestPoints = 4;
constexpr double kThreshold_px = 8.0;
constexpr int kMostSamples = 5000;

std::vector<Correspondence> correspondencesOf(const MarkedView& view) {
  std::vector<Correspondence> made;
  for (const PointPair& point : view.marks.points)
    if (point.used()) made.push_back({*point.point_in_station_m, *point.pixel, point.sigma_px});
  return made;
}

/// Camera from station.
std::optional<Pose> consensus(const MarkedView& view, double threshold_px) {
  const std::vector<Correspondence> points = correspondencesOf(view);
  const int count = static_cast<int>(points.size());
  Arena counter;
  PnpRansac counted;
  if (counted.create(count, counter) != Status::kOk) return {};
  std::vector<std::byte> memory(counter.highWater() + Arena::kAlignment);
  Arena arena(memory);
  PnpRansac ransac;
  if (ransac.create(count, arena) != Status::kOk) return {};
  std::vector<std::uint8_t> inlier(points.size());
  std::vector<double> residual_px(points.size());
  PnpSolution solution;
  solution.inlier = inlier;
  solution.residual_px = residual_px;
  PnpOptions options;
  options.sampler = PnpSampler::kP3p;
  options.min_inliers = static_cast<std::int32_t>(kFewestPoints);
  options.max_samples = kMostSamples;
  Status status = ransac.begin(points, view.camera, {}, threshold_px, options, solution);
  bool done = false;
  while (status == Status::kOk && !done) status = ransac.step(done);
  if (status != Status::kOk) return {};
  return solution.camera_from_station;
}

}  // namespace

std::optional<Pose> firstPose(std::span<const MarkedView> views) {
  const MarkedView* most = nullptr;
  std::size_t most_points = kFewestPoints - 1;
  for (const MarkedView& view : views) {
    const std::size_t points = correspondencesOf(view).size();
    if (points <= most_points) continue;
    most = &view;
    most_points = points;
  }
  if (most == nullptr) return {};
  // Careful marks first; then any pose at all, for marks that are far out.
  for (const double threshold_px : {kThreshold_px, 10.0 * kThreshold_px, 1e4}) {
    const std::optional<Pose> camera_from_station = consensus(*most, threshold_px);
    if (camera_from_station) return most->camera_from_rig.inverse() * *camera_from_station;
  }
  return {};
}

std::optional<Pose> mirroredPose(std::span<const MarkedView> views, const Pose& rig_from_station) {
  const MarkedSpread spread = markedSpread(views);
  if (!spread.coplanar()) return {};
  const Pose camera_from_station = views.front().camera_from_rig * rig_from_station;
  const Eigen::Vector3d sight = (camera_from_station * spread.middle_in_station_m).normalized();
  Eigen::Vector3d normal = camera_from_station.rotation * spread.axes_in_station.col(2);
  if (normal.dot(sight) > 0.0) normal = -normal;
  const Eigen::Vector3d mirrored = 2.0 * normal.dot(sight) * sight - normal;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(normal, mirrored);
  Pose camera_twin;
  camera_twin.rotation = (turn * camera_from_station.rotation).normalized();
  camera_twin.translation_m = camera_from_station * spread.middle_in_station_m -
                              camera_twin.rotation * spread.middle_in_station_m;
  return views.front().camera_from_rig.inverse() * camera_twin;
}

}  // namespace boresight::sessions
