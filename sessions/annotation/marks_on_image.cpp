// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_on_image.h"

#include <optional>

#include <Eigen/Geometry>

#include "sessions/annotation/mark_equations.h"
#include "sessions/run/surface_point.h"

namespace boresight::sessions {
PredictedPlace predictPlace(const Camera& camera, const Pose& camera_from_station,
                            const Eigen::Vector3d& point_in_station_m) {
  PredictedPlace made;
  const Eigen::Vector3d point = camera_from_station * point_in_station_m;
  made.valid = projectWithJacobian(camera, point, made.pixel, made.pixel_by_point);
  if (!made.valid) return made;
  made.depth_m = point.z();
  // The point moves by omega x p + v.
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d row = made.pixel_by_point.row(i).transpose();
    made.pixel_by_xi.row(i) << point.cross(row).transpose(), row.transpose();
  }
  return made;
}

bool isInImage(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 &&
         pixel.y() < camera.height - 0.5;
}

bool isSeen(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
            const Eigen::Vector3d& point_in_station_m) {
  const Eigen::Vector3d point = camera_from_station * point_in_station_m;
  Eigen::Vector2d pixel;
  if (!project(camera, point, pixel)) return false;
  const auto surface = surfacePointAt(camera, mesh, camera_from_station, pixel);
  return !surface || surface->depth_m > point.z() * (1.0 - kHidingShare);
}

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
    for (int end = 0; end < 2; ++end)
      vectors.push_back({line.id, ends[end] - mark.residual_px[end] * mark.across[end], ends[end]});
  }
  return vectors;
}

}  // namespace boresight::sessions
