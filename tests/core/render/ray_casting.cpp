// SPDX-License-Identifier: Apache-2.0
#include "tests/core/render/ray_casting.h"

#include <cmath>

#include <Eigen/Geometry>

namespace boresight::testing {

RayCaster::RayCaster(const SceneMesh& mesh, const Pose& camera_from_station, double near_plane_m)
    : near_plane_m_(near_plane_m) {
  for (const Face& face : mesh.faces) {
    Eigen::Vector3d v[3];
    for (std::size_t i = 0; i < 3; ++i)
      v[i] =
          camera_from_station *
          Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(face.vertex[i])].cast<double>());
    triangles_.push_back({v[0], v[1] - v[0], v[2] - v[0]});
  }
}

RayHit RayCaster::cast(const Eigen::Vector3d& ray) const {
  RayHit hit;
  hit.depth_m = 1e300;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const Eigen::Vector3d p = ray.cross(t.edge2);
    const double determinant = t.edge1.dot(p);
    if (determinant == 0.0) continue;
    const Eigen::Vector3d s = -t.corner;
    const double u = s.dot(p) / determinant;
    if (u < 0.0 || u > 1.0) continue;
    const Eigen::Vector3d q = s.cross(t.edge1);
    const double v = ray.dot(q) / determinant;
    if (v < 0.0 || u + v > 1.0) continue;
    const double depth = t.edge2.dot(q) / determinant;
    if (depth < near_plane_m_ || depth >= hit.depth_m) continue;
    hit.depth_m = depth;
    hit.face = static_cast<int>(i);
  }
  return hit;
}

bool RayCaster::sameFaceAround(const Camera& camera, const Eigen::Vector2d& pixel, double radius_px,
                               int face) const {
  for (int i = 0; i < 8; ++i) {
    const double angle = M_PI * i / 4.0;
    Eigen::Vector3d ray;
    if (!unproject(camera, pixel + radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                   ray))
      return false;
    if (cast(ray).face != face) return false;
  }
  return true;
}

double RayCaster::planeDepth(int face, const Eigen::Vector3d& ray) const {
  const Triangle& t = triangles_[static_cast<std::size_t>(face)];
  const Eigen::Vector3d normal = t.edge1.cross(t.edge2);
  return normal.dot(t.corner) / normal.dot(ray);
}

}  // namespace boresight::testing
