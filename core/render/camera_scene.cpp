// SPDX-License-Identifier: Apache-2.0
#include "core/render/camera_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/math.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Faces that turn by more than 45 deg are compared pixel by pixel whatever the thresholds.
constexpr double kSharpestSmooth = 0.7071;

/// Bounds of a face that crosses the near plane or leaves the region where projection is well
/// behaved: what is left of it beyond the near plane has a bounding box in (x/z, y/z).
PixelBounds clippedBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face) {
  std::array<Eigen::Vector3d, 3> corner;
  for (int i = 0; i < 3; ++i) corner[static_cast<std::size_t>(i)] = scene.vertex(face, i);
  const double near_m = scene.near_plane_m;
  double x_min = 1e300, x_max = -1e300, y_min = 1e300, y_max = -1e300;
  const auto include = [&](double x, double y) {
    x_min = std::min(x_min, x);
    x_max = std::max(x_max, x);
    y_min = std::min(y_min, y);
    y_max = std::max(y_max, y);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corner[i];
    const Eigen::Vector3d& b = corner[(i + 1) % 3];
    if (a.z() >= near_m) include(a.x() / a.z(), a.y() / a.z());
    if ((a.z() >= near_m) == (b.z() >= near_m)) continue;
    const double s = (near_m - a.z()) / (b.z() - a.z());
    include((a.x() + s * (b.x() - a.x())) / near_m, (a.y() + s * (b.y() - a.y())) / near_m);
  }
  PixelBounds bounds;
  if (!(x_min <= x_max && y_min <= y_max)) return bounds;
  const double slack_x = 1e-9 * (1.0 + std::abs(x_min) + std::abs(x_max));
  const double slack_y = 1e-9 * (1.0 + std::abs(y_min) + std::abs(y_max));
  const RayGrid::Range columns = rays.columnsWithin(x_min - slack_x, x_max + slack_x);
  const RayGrid::Range rows = rays.rowsWithin(y_min - slack_y, y_max + slack_y);
  bounds = {columns.first, columns.last, rows.first, rows.last};
  return bounds;
}

}  // namespace

Status CameraScene::create(const MeshView& mesh, const MeshAdjacency& adjacency,
                           double near_plane_m, Arena& kept, Arena& scratch, CameraScene& scene) {
  scene = CameraScene();
  const Status status = kept.countsOnly() ? Status::kOk : validateMesh(mesh);
  if (status != Status::kOk) return status;
  if (adjacency.neighbour.size() != mesh.faces.size() && !kept.countsOnly())
    return Status::kInvalidMesh;
  scene.mesh = mesh;
  scene.adjacency = adjacency;
  scene.near_plane_m = near_plane_m;
  scene.cos_normal_threshold = kept.allocate<double>(mesh.parts.size());
  scene.face_flags = kept.allocate<std::uint8_t>(mesh.faces.size());
  scene.vertex_in_camera_m = scratch.allocate<Eigen::Vector3d>(mesh.vertices_in_station_m.size());
  scene.vertex_px = scratch.allocate<Pixel>(mesh.vertices_in_station_m.size());
  if (kept.countsOnly()) return Status::kOk;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    scene.cos_normal_threshold[i] =
        cosine(std::clamp(mesh.parts[i].normal_threshold_rad, 0.0, kPi));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) scene.face_flags[i] = scene.smoothEdges(i);
  return Status::kOk;
}

/// Outer normal of a face in the station frame, not of unit length.
Eigen::Vector3d CameraScene::outerNormal(std::size_t face) const {
  Eigen::Vector3d corner[3];
  for (std::size_t i = 0; i < 3; ++i)
    corner[i] = mesh.vertices_in_station_m[static_cast<std::size_t>(mesh.faces[face].vertex[i])]
                    .cast<double>();
  return crossProduct(corner[1] - corner[0], corner[2] - corner[0]);
}

std::uint8_t CameraScene::smoothEdges(std::size_t face) const {
  std::uint8_t flags = 0;
  const Face& here = mesh.faces[face];
  const Eigen::Vector3d normal = outerNormal(face);
  const double length2 = dotProduct(normal, normal);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t beyond = adjacency.neighbour[face][i];
    if (beyond < 0) continue;
    const auto other = static_cast<std::size_t>(beyond);
    const Face& there = mesh.faces[other];
    bool alike = false;  // the other runs along the common edge the other way
    for (std::size_t k = 0; k < 3; ++k)
      alike = alike || (there.vertex[k] == here.vertex[(i + 1) % 3] &&
                        there.vertex[(k + 1) % 3] == here.vertex[i]);
    const Eigen::Vector3d other_normal = outerNormal(other);
    const double cosine_here = cos_normal_threshold[mesh.part_of_face[face]];
    const double cosine_there = cos_normal_threshold[mesh.part_of_face[other]];
    const double dot = dotProduct(normal, other_normal);
    const double lengths = std::sqrt(length2 * dotProduct(other_normal, other_normal));
    if (alike && lengths > 0.0 &&
        dot > std::max(std::max(cosine_here, cosine_there), kSharpestSmooth) * lengths)
      flags = static_cast<std::uint8_t>(flags | (1U << i));
  }
  return flags;
}

void CameraScene::orient(std::int32_t face) {
  const Eigen::Vector3d& v0 = vertex(face, 0);
  const Eigen::Vector3d normal = crossProduct(vertex(face, 1) - v0, vertex(face, 2) - v0);
  std::uint8_t& flags = face_flags[static_cast<std::size_t>(face)];
  flags = static_cast<std::uint8_t>(flags & ~kFrontFacing);
  if (dotProduct(normal, v0) < 0.0) flags = static_cast<std::uint8_t>(flags | kFrontFacing);
}

void CameraScene::transform(const Pose& camera_from_station, const RayGrid& rays, std::size_t first,
                            std::size_t last) {
  const Eigen::Matrix3d r = camera_from_station.matrix();
  const Eigen::Vector3d& t = camera_from_station.translation_m;
  const Camera& camera = rays.camera();
  // The bound on the bend of lines holds over the image and one node beyond it.
  const bool pinhole = camera.model == CameraModel::kPinhole;
  const double reach = RayGrid::kSpacing_px;
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector3d p = mesh.vertices_in_station_m[i].cast<double>();
    Eigen::Vector3d& q = vertex_in_camera_m[i];
    for (int k = 0; k < 3; ++k)
      q[k] = ((r(k, 0) * p.x() + r(k, 1) * p.y()) + r(k, 2) * p.z()) + t[k];
    vertex_px[i] = {kNotProjected, kNotProjected};
    Eigen::Vector2d pixel;
    if (!(q.z() >= near_plane_m) || !project(camera, q, pixel)) continue;
    const bool usable = pinhole ? std::abs(pixel.x()) < 1e9 && std::abs(pixel.y()) < 1e9
                                : pixel.x() >= -reach && pixel.x() <= camera.width - 1 + reach &&
                                      pixel.y() >= -reach && pixel.y() <= camera.height - 1 + reach;
    if (usable) vertex_px[i] = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
  }
}

bool faceEdges(const CameraScene& scene, std::int32_t face, Eigen::Vector3d edge[3]) {
  const Eigen::Vector3d& v0 = scene.vertex(face, 0);
  const Eigen::Vector3d& v1 = scene.vertex(face, 1);
  const Eigen::Vector3d& v2 = scene.vertex(face, 2);
  edge[0] = crossProduct(v0, v1);
  edge[1] = crossProduct(v1, v2);
  edge[2] = crossProduct(v2, v0);
  const double determinant = dotProduct(edge[0], v2);
  if (determinant < 0.0)
    for (int i = 0; i < 3; ++i) edge[i] = -edge[i];
  return determinant > 0.0 || determinant < 0.0;
}

bool facePlane(const CameraScene& scene, std::int32_t face, Eigen::Vector3d& plane) {
  const Eigen::Vector3d& v0 = scene.vertex(face, 0);
  const Eigen::Vector3d& v1 = scene.vertex(face, 1);
  const Eigen::Vector3d& v2 = scene.vertex(face, 2);
  const Eigen::Vector3d normal = crossProduct(v1 - v0, v2 - v0);
  const double inverse = 1.0 / dotProduct(normal, v0);
  if (!(std::abs(inverse) < 1e300)) return false;
  plane = normal * inverse;
  return true;
}

PixelBounds faceBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face) {
  const Face& indices = scene.mesh.faces[static_cast<std::size_t>(face)];
  const CameraScene::Pixel& a = scene.vertex_px[static_cast<std::size_t>(indices.vertex[0])];
  const CameraScene::Pixel& b = scene.vertex_px[static_cast<std::size_t>(indices.vertex[1])];
  const CameraScene::Pixel& c = scene.vertex_px[static_cast<std::size_t>(indices.vertex[2])];
  const double x_max = std::max({a.x, b.x, c.x});
  if (x_max >= static_cast<double>(CameraScene::kNotProjected))
    return clippedBounds(scene, rays, face);
  const double x_min = std::min({a.x, b.x, c.x});
  const double y_min = std::min({a.y, b.y, c.y});
  const double y_max = std::max({a.y, b.y, c.y});
  // A line of length L and curvature k stays within k L^2 / 8 of its chord; twice that, and the
  // rounding of the pixels to single precision.
  const double length2 = (x_max - x_min) * (x_max - x_min) + (y_max - y_min) * (y_max - y_min);
  const double margin =
      0.25 * rays.lineBend_per_px() * length2 + 0.01 +
      1e-6 * (std::abs(x_min) + std::abs(x_max) + std::abs(y_min) + std::abs(y_max));
  const Camera& camera = rays.camera();
  PixelBounds bounds;
  bounds.x_first = ceilClamped(x_min - margin, 0, camera.width);
  bounds.x_last = floorClamped(x_max + margin, -1, camera.width - 1);
  bounds.y_first = ceilClamped(y_min - margin, 0, camera.height);
  bounds.y_last = floorClamped(y_max + margin, -1, camera.height - 1);
  return bounds;
}

}  // namespace boresight
