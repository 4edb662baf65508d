// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/surface_point.h"

#include <cmath>

#include <Eigen/Geometry>

namespace boresight::sessions {
namespace {

/// Distance along the ray in lengths of `direction`, or a negative number (Moeller and Trumbore
/// 1997).
double distanceToFace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d across = direction.cross(ac);
  const double volume = ab.dot(across);
  if (std::abs(volume) < 1e-18) return -1.0;
  const Eigen::Vector3d from_a = origin - a;
  const double u = from_a.dot(across) / volume;
  if (u < 0.0 || u > 1.0) return -1.0;
  const Eigen::Vector3d other = from_a.cross(ab);
  const double v = direction.dot(other) / volume;
  if (v < 0.0 || u + v > 1.0) return -1.0;
  return ac.dot(other) / volume;
}

}  // namespace

std::optional<SurfacePoint> surfacePointAt(const Camera& camera, const MeshView& mesh,
                                           const Pose& camera_from_station,
                                           const Eigen::Vector2d& pixel) {
  Ray ray;
  if (!unprojectRay(camera, pixel, ray)) return std::nullopt;
  const Pose station_from_camera = camera_from_station.inverse();
  const Eigen::Vector3d origin = station_from_camera * ray.origin_m;
  const Eigen::Vector3d direction =
      station_from_camera.rotation * ray.direction;  // z = 1 in the camera
  std::optional<SurfacePoint> nearest;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const auto corner = [&mesh, i](std::size_t k) {
      const auto vertex = static_cast<std::size_t>(mesh.faces[i].vertex[k]);
      return Eigen::Vector3d(mesh.vertices_in_station_m[vertex].cast<double>());
    };
    const double depth_m = distanceToFace(origin, direction, corner(0), corner(1), corner(2));
    if (depth_m <= 0.0 || (nearest && depth_m >= nearest->depth_m)) continue;
    nearest = SurfacePoint{origin + depth_m * direction, depth_m, static_cast<std::int32_t>(i)};
  }
  return nearest;
}

}  // namespace boresight::sessions
