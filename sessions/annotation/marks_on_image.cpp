// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_on_image.h"

#include <optional>

#include <Eigen/Geometry>

#include "sessions/annotation/mark_equations.h"
#include "sessions/annotation/predicted_place.h"

namespace boresight::sessions {
namespace {

/// Across the edge at a place near it, towards where `markResidual` counts as positive: a quarter
/// turn from the way in which the edge's ray goes round the plane through the place where the ray
/// starts.
std::optional<Eigen::Vector2d> acrossEdge(const Camera& camera, const Pose& camera_from_station,
                                          const ModelEdge& edge, const Eigen::Vector2d& seen) {
  Ray ray;
  if (!unprojectRay(camera, seen, ray)) return {};
  const Eigen::Vector3d d = ray.direction.normalized();
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  if (!projectWithJacobian(camera, ray.origin_m + d, pixel, jacobian)) return {};
  const Eigen::Vector3d normal =
      (camera_from_station * edge.start_in_station_m - ray.origin_m)
          .cross(camera_from_station * edge.end_in_station_m - ray.origin_m)
          .normalized();
  const Eigen::Vector2d along = (jacobian * normal.cross(d)).normalized();
  return Eigen::Vector2d(-along.y(), along.x());
}

}  // namespace

std::vector<Eigen::Vector2d> edgeOnImage(const Camera& camera, const Pose& camera_from_station,
                                         const ModelEdge& edge, int pieces) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    const Eigen::Vector3d point_m =
        (1.0 - share) * edge.start_in_station_m + share * edge.end_in_station_m;
    const PredictedPlace place = predictPlace(camera, camera_from_station, point_m);
    if (place.valid) places.push_back(place.pixel);
  }
  return places;
}

std::vector<MarkVector> markVectors(const MarkedView& view, const Pose& camera_from_station) {
  std::vector<MarkVector> vectors;
  for (std::size_t i = 0; i < view.marks.points.size(); ++i) {
    const PointPair& point = view.marks.points[i];
    if (!point.complete()) continue;
    const MarkResidual mark = markResidual(view, {0, MarkKind::kPoint, i}, camera_from_station);
    if (mark.valid) vectors.push_back({point.id, *point.pixel - mark.residual_px, *point.pixel});
  }
  for (std::size_t i = 0; i < view.marks.lines.size(); ++i) {
    const LinePair& line = view.marks.lines[i];
    if (!line.complete()) continue;
    const MarkResidual mark = markResidual(view, {0, MarkKind::kLine, i}, camera_from_station);
    if (!mark.valid) continue;
    const Eigen::Vector2d ends[2] = {line.line->start, line.line->end};
    for (int end = 0; end < 2; ++end) {
      const auto across = acrossEdge(view.camera, camera_from_station, *line.edge, ends[end]);
      if (across)
        vectors.push_back({line.id, ends[end] - mark.residual_px[end] * *across, ends[end]});
    }
  }
  return vectors;
}

}  // namespace boresight::sessions
