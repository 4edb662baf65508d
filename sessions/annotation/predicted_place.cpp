// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/predicted_place.h"

#include <Eigen/Geometry>

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

}  // namespace boresight::sessions
