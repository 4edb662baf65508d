// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::sessions {
namespace {

constexpr std::int32_t kLeafFaces = 4;
/// Of a face's sides: a ray along the edge between two faces must not slip through.
constexpr double kSlack = 1e-12;

std::array<Eigen::Vector3d, 3> corners(const MeshView& mesh, std::int32_t face) {
  const auto& vertex = mesh.faces[static_cast<std::size_t>(face)].vertex;
  const auto at = [&](std::size_t i) -> Eigen::Vector3d {
    return mesh.vertices_in_station_m[static_cast<std::size_t>(vertex[i])].cast<double>();
  };
  return {at(0), at(1), at(2)};
}

bool isFixedToCamera(const MeshView& mesh, std::int32_t face) {
  return mesh.parts[mesh.part_of_face[static_cast<std::size_t>(face)]].fixed_to_camera;
}

/// Distance along the ray in lengths of `direction`, or a negative number (Moeller and Trumbore
/// 1997).
double distanceToFace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      const std::array<Eigen::Vector3d, 3>& corner) {
  const Eigen::Vector3d ab = corner[1] - corner[0];
  const Eigen::Vector3d ac = corner[2] - corner[0];
  const Eigen::Vector3d across = direction.cross(ac);
  const double volume = ab.dot(across);
  if (volume == 0.0) return -1.0;
  const Eigen::Vector3d from_a = origin - corner[0];
  const double u = from_a.dot(across) / volume;
  const Eigen::Vector3d other = from_a.cross(ab);
  const double v = direction.dot(other) / volume;
  if (!(u >= -kSlack && v >= -kSlack && u + v <= 1.0 + kSlack)) return -1.0;
  return ac.dot(other) / volume;
}

/// Whether a ray enters a box before `farthest`; a little air, for rounding must not lose a face
/// that lies in the box's side.
bool meets(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
           const Eigen::Vector3d& direction, double farthest) {
  double enter = 0.0;
  double leave = farthest;
  for (int axis = 0; axis < 3; ++axis) {
    const double air = 1e-9 * (1.0 + std::abs(origin[axis]) + std::abs(box.max()[axis]));
    const double low = box.min()[axis] - air - origin[axis];
    const double high = box.max()[axis] + air - origin[axis];
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double a = low / direction[axis];
    const double b = high / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace

FaceTree::FaceTree(const MeshView& mesh) : mesh_(mesh) {
  std::vector<Eigen::Vector3d> middle_m(mesh.faces.size());
  for (std::int32_t face = 0; face < static_cast<std::int32_t>(mesh.faces.size()); ++face) {
    if (isFixedToCamera(mesh, face)) continue;
    const auto corner = corners(mesh_, face);
    order_.push_back(face);
    middle_m[static_cast<std::size_t>(face)] = (corner[0] + corner[1] + corner[2]) / 3.0;
  }
  addNode(0, static_cast<std::int32_t>(order_.size()));
  for (std::size_t node = 0; node < nodes_.size(); ++node) split(node, middle_m);
}

void FaceTree::addNode(std::int32_t first, std::int32_t count) {
  Node& node = nodes_.emplace_back();
  node.first = first;
  node.count = count;
  for (std::int32_t i = first; i < first + count; ++i)
    for (const Eigen::Vector3d& corner : corners(mesh_, order_[static_cast<std::size_t>(i)]))
      node.box_m.extend(corner);
}

void FaceTree::split(std::size_t node, const std::vector<Eigen::Vector3d>& middle_m) {
  const Node whole = nodes_[node];
  if (whole.count <= kLeafFaces) return;
  Eigen::Index axis = 0;
  whole.box_m.sizes().maxCoeff(&axis);
  const std::int32_t half = whole.count / 2;
  const auto first = order_.begin() + whole.first;
  std::nth_element(first, first + half, first + whole.count, [&](std::int32_t a, std::int32_t b) {
    return middle_m[static_cast<std::size_t>(a)][axis] <
           middle_m[static_cast<std::size_t>(b)][axis];
  });
  nodes_[node].child = static_cast<std::int32_t>(nodes_.size());
  addNode(whole.first, half);
  addNode(whole.first + half, whole.count - half);
}

std::optional<RayHit> FaceTree::firstHit(const Eigen::Vector3d& origin_m,
                                         const Eigen::Vector3d& direction, double farthest) const {
  std::optional<RayHit> nearest;
  // Halving a mesh of 2^31 faces at the median, there are never more than this many to come back
  // to.
  std::array<std::int32_t, 64> waiting{};
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(waiting[--count])];
    if (!meets(node.box_m, origin_m, direction, farthest)) continue;
    if (node.child >= 0) {
      waiting[count++] = node.child;
      waiting[count++] = node.child + 1;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const std::int32_t face = order_[static_cast<std::size_t>(i)];
      const double distance = distanceToFace(origin_m, direction, corners(mesh_, face));
      if (!(distance > 0.0 && distance < farthest)) continue;
      farthest = distance;
      nearest = RayHit{distance, face};
    }
  }
  return nearest;
}

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
  double nearest_of_camera_m = std::numeric_limits<double>::infinity();
  for (std::int32_t face = 0; face < static_cast<std::int32_t>(mesh.faces.size()); ++face) {
    if (isFixedToCamera(mesh, face)) {
      const double depth_m = distanceToFace(ray.origin_m, ray.direction, corners(mesh, face));
      if (depth_m > 0.0) nearest_of_camera_m = std::min(nearest_of_camera_m, depth_m);
      continue;
    }
    const double depth_m = distanceToFace(origin, direction, corners(mesh, face));
    if (depth_m <= 0.0 || (nearest && depth_m >= nearest->depth_m)) continue;
    nearest = SurfacePoint{origin + depth_m * direction, depth_m, face};
  }
  if (nearest && nearest_of_camera_m < nearest->depth_m) return std::nullopt;
  return nearest;
}

Measurement measureBetween(const Camera& camera, const MeshView& mesh,
                           const Pose& camera_from_station, const Eigen::Vector2d& from_px,
                           const Eigen::Vector2d& to_px) {
  Measurement measured;
  measured.image_px = (to_px - from_px).norm();
  const auto from = surfacePointAt(camera, mesh, camera_from_station, from_px);
  const auto to = surfacePointAt(camera, mesh, camera_from_station, to_px);
  if (from && to) measured.surface_m = (to->in_station_m - from->in_station_m).norm();
  return measured;
}

}  // namespace boresight::sessions
