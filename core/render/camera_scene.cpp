// SPDX-License-Identifier: Apache-2.0
#include "core/render/camera_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Faces that turn by more than 45 deg are compared pixel by pixel for any thresholds.
constexpr double kSharpestSmooth = 0.7071;
/// Steps of 1/128 px at most.
constexpr int kMostShift = 7;
constexpr double kDeepest = 65535.0;
/// Scenes flatter than this towards the camera are given that depth.
constexpr double kThinnest_m = 1e-9;

/// NaN gives `low`.
double clamped(double value, double low, double high) {
  const double above = value > low ? value : low;
  return above < high ? above : high;
}

/// A rectangle, and how far lines may bend out of it.
struct FaceBox {
  double x_min = 1e300, x_max = -1e300, y_min = 1e300, y_max = -1e300;
  double margin = 0.0;

  void include(double x, double y) {
    x_min = std::min(x_min, x);
    x_max = std::max(x_max, x);
    y_min = std::min(y_min, y);
    y_max = std::max(y_max, y);
  }
  double length2() const {
    return (x_max - x_min) * (x_max - x_min) + (y_max - y_min) * (y_max - y_min);
  }
};

/// Bounds of a face that crosses the near plane or leaves the region where projection is well
/// behaved: what is left of it beyond the near plane has a bounding box in (x/z, y/z).
PixelBounds clippedBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face) {
  const Corners corner = scene.corners(face);
  const double near_m = CameraScene::kNearPlane_m;
  FaceBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corner[i];
    const Eigen::Vector3d& b = corner[(i + 1) % 3];
    if (a.z() >= near_m) box.include(a.x() / a.z(), a.y() / a.z());
    if ((a.z() >= near_m) == (b.z() >= near_m)) continue;
    const double s = (near_m - a.z()) / (b.z() - a.z());
    box.include((a.x() + s * (b.x() - a.x())) / near_m, (a.y() + s * (b.y() - a.y())) / near_m);
  }
  if (!(box.x_min <= box.x_max && box.y_min <= box.y_max)) return {};
  const double slack_x = 1e-9 * (1.0 + std::abs(box.x_min) + std::abs(box.x_max));
  const double slack_y = 1e-9 * (1.0 + std::abs(box.y_min) + std::abs(box.y_max));
  const RayGrid::Range columns = rays.columnsWithin(box.x_min - slack_x, box.x_max + slack_x);
  const RayGrid::Range rows = rays.rowsWithin(box.y_min - slack_y, box.y_max + slack_y);
  return {columns.first, columns.last, rows.first, rows.last};
}

BoundingBox boxOfVertices(std::span<const Eigen::Vector3f> vertices_m) {
  Eigen::AlignedBox3f bounds_m;
  for (const Eigen::Vector3f& vertex : vertices_m) bounds_m.extend(vertex);
  return boxOf(bounds_m);
}

/// Bounds of the depths (z) of a box seen from a pose.
struct DepthBounds {
  double low_m = 0.0;
  double high_m = 0.0;
};

DepthBounds depthsOf(const BoundingBox& box, const Pose& camera_from_box) {
  const Eigen::Matrix3d r = camera_from_box.matrix();
  DepthBounds depths;
  depths.low_m = depths.high_m = camera_from_box.translation_m.z();
  for (int k = 0; k < 3; ++k) {
    depths.low_m += std::min(r(2, k) * box.minimum_m[k], r(2, k) * box.maximum_m[k]);
    depths.high_m += std::max(r(2, k) * box.minimum_m[k], r(2, k) * box.maximum_m[k]);
  }
  return depths;
}

}  // namespace

Status CameraScene::create(const MeshView& mesh, const MeshAdjacency& adjacency, Arena& kept,
                           Arena& scratch, CameraScene& scene) {
  scene = CameraScene();
  const Status status = kept.countsOnly() ? Status::kOk : validateMesh(mesh);
  if (status != Status::kOk) return status;
  if (adjacency.size() != mesh.faces.size() && !kept.countsOnly()) return Status::kInvalidMesh;
  scene.mesh = mesh;
  scene.adjacency = adjacency;
  scene.cos_normal_threshold = kept.allocate<double>(mesh.parts.size());
  scene.face_flags = kept.allocate<std::uint8_t>(mesh.faces.size());
  scene.vertex_px = scratch.allocate<FixedPixel>(mesh.vertices_in_station_m.size());
  scene.vertex_depth = scratch.allocate<std::uint16_t>(mesh.vertices_in_station_m.size());
  if (kept.countsOnly()) return Status::kOk;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    scene.cos_normal_threshold[i] = cos(std::clamp(mesh.parts[i].normal_threshold_rad, 0.0, kPi));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) scene.setFlags(i);
  scene.first_in_camera = firstVertexInCamera(mesh);
  scene.station_box = boxOfVertices(mesh.vertices_in_station_m.first(scene.first_in_camera));
  scene.camera_box = boxOfVertices(mesh.vertices_in_station_m.subspan(scene.first_in_camera));
  return Status::kOk;
}

/// Outer normal of a face in its part's frame, not of unit length.
Eigen::Vector3d CameraScene::outerNormal(std::size_t face) const {
  const Corners corner = mesh.corners(face);
  return crossProduct(corner[1] - corner[0], corner[2] - corner[0]);
}

/// Vertices are known to single precision. The normal of a face whose altitude is below some thirty
/// times that is noise.
bool CameraScene::normalIsKnown(std::size_t face, const Eigen::Vector3d& normal) const {
  constexpr double kAltitude = 2e-6;  // relative to the coordinates' size in the part's frame
  const Corners corner = mesh.corners(face);
  double size = 0.0;
  for (const Eigen::Vector3d& point : corner) size = std::max(size, point.cwiseAbs().maxCoeff());
  double longest2 = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d side = corner[i < 2 ? i + 1 : 0] - corner[i];
    longest2 = std::max(longest2, dotProduct(side, side));
  }
  const double altitude_m = kAltitude * size;
  return dotProduct(normal, normal) > altitude_m * altitude_m * longest2;
}

/// Sets a face's kNormalKnown, and the bits of its edges to faces after it, on both sides.
void CameraScene::setFlags(std::size_t face) {
  const Face& own = mesh.faces[face];
  const Eigen::Vector3d normal = outerNormal(face);
  const double length2 = dotProduct(normal, normal);
  unsigned flags = face_flags[face];
  if (normalIsKnown(face, normal)) flags |= kNormalKnown;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t beyond =
        adjacency.beyond(static_cast<std::int32_t>(face), static_cast<int>(i));
    if (beyond < 0 || static_cast<std::size_t>(beyond) < face) continue;
    const auto neighbour_index = static_cast<std::size_t>(beyond);
    const Face& neighbour = mesh.faces[neighbour_index];
    const std::int32_t from = own.vertex[i];
    const std::int32_t to = own.vertex[i < 2 ? i + 1 : 0];
    for (std::size_t k = 0; k < 3; ++k) {
      // Same orientation: the neighbour traverses the common edge in the opposite direction.
      if (neighbour.vertex[k] != to || neighbour.vertex[k < 2 ? k + 1 : 0] != from) continue;
      const Eigen::Vector3d other_normal = outerNormal(neighbour_index);
      const double lengths = std::sqrt(length2 * dotProduct(other_normal, other_normal));
      const double threshold =
          std::max(std::max(cos_normal_threshold[mesh.part_of_face[face]],
                            cos_normal_threshold[mesh.part_of_face[neighbour_index]]),
                   kSharpestSmooth);
      if (!(lengths > 0.0 && dotProduct(normal, other_normal) > threshold * lengths)) continue;
      flags |= 1U << i;
      face_flags[neighbour_index] =
          static_cast<std::uint8_t>(face_flags[neighbour_index] | (1U << k));
    }
  }
  face_flags[face] = static_cast<std::uint8_t>(flags);
}

void CameraScene::orient(std::int32_t face) {
  const Corners corner = corners(face);
  const Eigen::Vector3d normal = crossProduct(corner[1] - corner[0], corner[2] - corner[0]);
  setFrontFacing(face, dotProduct(normal, corner[0]) < 0.0);
}

void CameraScene::begin(const Pose& camera_from_station, const RayGrid& rays, const Pose& turn) {
  const Camera& camera = rays.camera();
  station_ = Placement(camera_from_station);
  camera_ = Placement(turn);
  pupil_moves_ = pupilMoves(camera);
  rays_camera_ = camera;
  // The middle is a pixel's centre, and a node's spacing beyond the image still has a place.
  scale.middle_x = camera.width / 2;
  scale.middle_y = camera.height / 2;
  const int reach_px = std::max(camera.width, camera.height) / 2 + 2 * RayGrid::kSpacing_px;
  scale.shift = 0;
  while (scale.shift < kMostShift && (reach_px << (scale.shift + 1)) < FixedScale::kLimit)
    ++scale.shift;

  DepthBounds depths = depthsOf(station_box, camera_from_station);
  if (first_in_camera < mesh.vertices_in_station_m.size()) {
    const DepthBounds of_camera = depthsOf(camera_box, turn);
    depths.low_m = std::min(depths.low_m, of_camera.low_m);
    depths.high_m = std::max(depths.high_m, of_camera.high_m);
  }
  scale.low_m = depths.low_m;
  scale.per_m = kDeepest / std::max(depths.high_m - depths.low_m, kThinnest_m);
  // One step for the rounding of each, and single precision of 1/z many times over.
  scale.gap = 2 + ceilClamped(1e-6 * std::abs(depths.high_m) * scale.per_m, 0, 1 << 17);
}

namespace {

/// A block of vertices, coordinate by coordinate, so that loops need no branch.
constexpr std::size_t kBlock = 64;
struct VertexBlock {
  double station[3][kBlock];
  double camera[3][kBlock];
};

void rotate(const Eigen::Matrix3d& r, const Eigen::Vector3d& t_m, VertexBlock& block) {
  for (int k = 0; k < 3; ++k) {
    const double rx = r(k, 0);
    const double ry = r(k, 1);
    const double rz = r(k, 2);
    const double translation_m = t_m[k];
    for (std::size_t i = 0; i < kBlock; ++i)
      block.camera[k][i] =
          ((rx * block.station[0][i] + ry * block.station[1][i]) + rz * block.station[2][i]) +
          translation_m;
  }
}

/// Vertices as seen from the pupils that see them: from there on, all rays have one origin.
void moveToPupil(const Camera& camera, std::size_t count, VertexBlock& block) {
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d seen =
        seenFromPupil(camera, {block.camera[0][i], block.camera[1][i], block.camera[2][i]});
    for (int k = 0; k < 3; ++k) block.camera[k][i] = seen[k];
  }
}

void projectPinhole(const Camera& camera, const FixedScale& scale, const VertexBlock& block,
                    std::span<FixedPixel> pixels) {
  const auto& [x_m, y_m, z_m] = block.camera;
  // Counted from -kLimit, so that truncation rounds towards the same side everywhere.
  const double steps = scale.steps();
  const double focal_x = camera.fx * steps;
  const double focal_y = camera.fy * steps;
  const double from_x = (camera.cx - scale.middle_x) * steps + (FixedScale::kLimit + 0.5);
  const double from_y = (camera.cy - scale.middle_y) * steps + (FixedScale::kLimit + 0.5);
  int fixed_x[kBlock];
  int fixed_y[kBlock];
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double inverse_z = 1.0 / z_m[i];
    const double x = x_m[i] * inverse_z * focal_x + from_x;
    const double y = y_m[i] * inverse_z * focal_y + from_y;
    fixed_x[i] = static_cast<int>(clamped(x, 0.0, 2.0 * FixedScale::kLimit));
    fixed_y[i] = static_cast<int>(clamped(y, 0.0, 2.0 * FixedScale::kLimit));
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = {static_cast<std::int16_t>(fixed_x[i] - FixedScale::kLimit),
                 static_cast<std::int16_t>(fixed_y[i] - FixedScale::kLimit)};
    if (!(z_m[i] >= CameraScene::kNearPlane_m))
      pixels[i] = {FixedPixel::kNotProjected, FixedPixel::kNotProjected};
  }
}

void projectDistorted(const Camera& camera, const FixedScale& scale, const VertexBlock& block,
                      std::span<FixedPixel> pixels) {
  const auto& [x_m, y_m, z_m] = block.camera;
  // The bound on the bend of lines holds over the image and one node beyond it.
  const double reach = RayGrid::kSpacing_px;
  const double steps = scale.steps();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector3d q(x_m[i], y_m[i], z_m[i]);
    pixels[i] = {FixedPixel::kNotProjected, FixedPixel::kNotProjected};
    Eigen::Vector2d pixel;
    if (!(q.z() >= CameraScene::kNearPlane_m) || !projectDirection(camera, q, pixel)) continue;
    if (!(pixel.x() >= -reach && pixel.x() <= camera.width - 1 + reach && pixel.y() >= -reach &&
          pixel.y() <= camera.height - 1 + reach))
      continue;
    const auto fixed = [steps](double value_px) {
      return static_cast<std::int16_t>(
          floorClamped(value_px * steps + 0.5, -FixedScale::kLimit, FixedScale::kLimit));
    };
    pixels[i] = {fixed(pixel.x() - scale.middle_x), fixed(pixel.y() - scale.middle_y)};
  }
}

}  // namespace

void CameraScene::transform(const RayGrid& rays, std::size_t first, std::size_t last) {
  transformBy(station_, rays, first, std::min(last, first_in_camera));
  transformBy(camera_, rays, std::max(first, first_in_camera), last);
}

void CameraScene::transformBy(const Placement& placed, const RayGrid& rays, std::size_t first,
                              std::size_t last) {
  VertexBlock block = {};
  double steps_of_depth[kBlock];
  for (std::size_t begin = first; begin < last; begin += kBlock) {
    const std::size_t count = std::min(kBlock, last - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f& p = mesh.vertices_in_station_m[begin + i];
      for (int k = 0; k < 3; ++k) block.station[k][i] = static_cast<double>(p[k]);
    }
    rotate(placed.r, placed.t_m, block);
    if (pupilMoves(rays.camera())) moveToPupil(rays.camera(), count, block);
    for (std::size_t i = 0; i < kBlock; ++i)
      steps_of_depth[i] = clamped((block.camera[2][i] - scale.low_m) * scale.per_m, 0.0, kDeepest);
    for (std::size_t i = 0; i < count; ++i)
      vertex_depth[begin + i] = static_cast<std::uint16_t>(static_cast<int>(steps_of_depth[i]));
    const std::span<FixedPixel> pixels = vertex_px.subspan(begin, count);
    const auto project_all = rays.level() ? projectPinhole : projectDistorted;
    project_all(rays.camera(), scale, block, pixels);
  }
}

bool faceEdges(const Corners& corners, Eigen::Vector3d edge[3]) {
  const auto& [v0, v1, v2] = corners;
  edge[0] = crossProduct(v0, v1);
  edge[1] = crossProduct(v1, v2);
  edge[2] = crossProduct(v2, v0);
  const double determinant = dotProduct(edge[0], v2);
  if (determinant < 0.0)
    for (int i = 0; i < 3; ++i) edge[i] = -edge[i];
  return determinant > 0.0 || determinant < 0.0;
}

namespace {

/// A line of length L and curvature k stays within k L^2 / 8 of its chord; twice that.
double bendMargin(const RayGrid& rays, double length2) {
  return 0.25 * rays.lineBend_per_px() * length2;
}

/// The box of a face whose edges may bend far, as some at the border of the valid field do: the
/// bends of an edge's segments are smaller by the square of their number. False when a segment ends
/// outside the valid field.
bool boxBySegments(const CameraScene& scene, const RayGrid& rays, std::int32_t face, FaceBox& box) {
  constexpr int kSegments = 8;
  const Corners corner = scene.corners(face);
  double longest2 = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& from = corner[i];
    const Eigen::Vector3d& to = corner[i < 2 ? i + 1 : 0];
    Eigen::Vector2d before;
    for (int k = 0; k <= kSegments; ++k) {
      const double s = k / static_cast<double>(kSegments);
      Eigen::Vector2d pixel;
      if (!projectDirection(rays.camera(), from + (to - from) * s, pixel)) return false;
      box.include(pixel.x(), pixel.y());
      if (k > 0) longest2 = std::max(longest2, (pixel - before).squaredNorm());
      before = pixel;
    }
  }
  box.margin = bendMargin(rays, longest2);
  return true;
}

}  // namespace

PixelBounds faceBounds(const CameraScene& scene, const RayGrid& rays, std::int32_t face) {
  constexpr double kFarBend_px = 8.0;
  const Face& indices = nth(scene.mesh.faces, face);
  FaceBox box;
  for (const std::int32_t vertex : indices.vertex) {
    const FixedPixel& pixel = nth(scene.vertex_px, vertex);
    if (pixel.x == FixedPixel::kNotProjected) return clippedBounds(scene, rays, face);
    box.include(pixel.x, pixel.y);
  }
  const double pixels_per_step = 1.0 / scene.scale.steps();
  box.x_min = scene.scale.middle_x + box.x_min * pixels_per_step;
  box.x_max = scene.scale.middle_x + box.x_max * pixels_per_step;
  box.y_min = scene.scale.middle_y + box.y_min * pixels_per_step;
  box.y_max = scene.scale.middle_y + box.y_max * pixels_per_step;
  box.margin = bendMargin(rays, box.length2());
  FaceBox by_segments;
  if (box.margin > kFarBend_px && boxBySegments(scene, rays, face, by_segments)) box = by_segments;
  // Half a step for the rounding of the vertices, and as much for all other rounding.
  const double margin = box.margin + pixels_per_step;
  const Camera& camera = rays.camera();
  PixelBounds bounds;
  bounds.x_first = ceilClamped(box.x_min - margin, 0, camera.width);
  bounds.x_last = floorClamped(box.x_max + margin, -1, camera.width - 1);
  bounds.y_first = ceilClamped(box.y_min - margin, 0, camera.height);
  bounds.y_last = floorClamped(box.y_max + margin, -1, camera.height - 1);
  return bounds;
}

}  // namespace boresight
