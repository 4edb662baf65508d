// SPDX-License-Identifier: Apache-2.0
#include "core/render/drawn_face.h"

#include <algorithm>
#include <limits>

namespace boresight {
namespace {

/// Altitude over length below which a triangle's plane is uncertain: 1e-3, squared.
constexpr double kThin2 = 1e-6;

/// Whether the line a x + b y + c = 0 belongs to the face on its positive side or to the other
/// face: a rule that changes with the line's sign.
bool ownsLine(const Eigen::Vector3d& edge) {
  if (edge.x() != 0.0) return edge.x() > 0.0;
  if (edge.y() != 0.0) return edge.y() > 0.0;
  return edge.z() > 0.0;
}

/// Whether a triangle has an area seen from the camera: as faceEdges() decides.
bool hasArea(const Eigen::Vector3d& v0, const Eigen::Vector3d& v1, const Eigen::Vector3d& v2) {
  const double determinant = dotProduct(crossProduct(v0, v1), v2);
  return determinant > 0.0 || determinant < 0.0;
}

}  // namespace

bool prepareEdges(const Corners& corners, DrawnFace& drawn) {
  Eigen::Vector3d edge[3];
  if (!faceEdges(corners, edge)) return false;
  for (int i = 0; i < 3; ++i) {
    drawn.a[i] = edge[i].x();
    drawn.b[i] = edge[i].y();
    drawn.c[i] = edge[i].z();
    drawn.limit[i] = ownsLine(edge[i]) ? 0.0 : std::numeric_limits<double>::denorm_min();
  }
  return true;
}

bool preparePlane(const Corners& corners, std::int32_t face, DrawnFace& drawn) {
  const auto& [v0, v1, v2] = corners;
  const double z_min = std::min({v0.z(), v1.z(), v2.z()});
  const double z_max = std::max({v0.z(), v1.z(), v2.z()});
  if (!(z_max >= CameraScene::kNearPlane_m) || !hasArea(v0, v1, v2)) return false;
  const Eigen::Vector3d side1 = v1 - v0;
  const Eigen::Vector3d side2 = v2 - v0;
  const Eigen::Vector3d normal = crossProduct(side1, side2);
  Eigen::Vector3d plane;
  if (!planeOf(normal, v0, plane)) return false;
  drawn.plane_x = plane.x();
  drawn.plane_y = plane.y();
  drawn.plane_1 = plane.z();
  // Within a face 1/z stays in a range; the plane of a sliver is too uncertain.
  const double length2 = std::max(dotProduct(side1, side1), dotProduct(side2, side2));
  const bool crosses_near_plane = !(z_min > CameraScene::kNearPlane_m);
  drawn.clamped =
      crosses_near_plane || !(dotProduct(normal, normal) > kThin2 * (length2 * length2));
  if (drawn.clamped) {
    drawn.nearest = 1.0 / CameraScene::kNearPlane_m;
    drawn.low = 1.0 / z_max;
    drawn.high = crosses_near_plane ? 2.0 * drawn.nearest : 1.0 / z_min;
  }
  drawn.face = face;
  return true;
}

bool prepareFace(const CameraScene& scene, std::int32_t face, DrawnFace& drawn) {
  const Corners corners = scene.corners(face);
  return prepareEdges(corners, drawn) && preparePlane(corners, face, drawn);
}

}  // namespace boresight
