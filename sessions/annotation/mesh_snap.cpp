// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mesh_snap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>

#include "core/base/symmetric_eigen.h"
#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kSmallestCircle = 8;   ///< corners
constexpr double kCircleDeviation = 0.03;    ///< of the radius
constexpr double kOcclusion = 1e-4;          ///< of the mesh's diagonal
constexpr std::size_t kMostSeenTests = 200;  ///< candidates that are tested for being seen

Eigen::Vector3d faceNormal(const MeshView& mesh, const Face& face) {
  const auto at = [&](int i) {
    return mesh
        .vertices_in_station_m[static_cast<std::size_t>(face.vertex[static_cast<std::size_t>(i)])]
        .cast<double>()
        .eval();
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

double distanceToChord(const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                       const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d way = end - start;
  const double squared = way.squaredNorm();
  const double share =
      squared > 0.0 ? std::clamp((pixel - start).dot(way) / squared, 0.0, 1.0) : 0.0;
  return (start + share * way - pixel).norm();
}

/// False where an edge surely stays farther away: no camera bends one by more than this share of
/// its length. An edge that projects in part only may be anywhere.
bool mayPass(const Camera& camera, const Pose& camera_from_station, const ModelEdge& edge,
             const Eigen::Vector2d& pixel, double radius_px) {
  constexpr double kMostBent = 0.25;
  Eigen::Vector2d start, end;
  if (!project(camera, camera_from_station * edge.start_in_station_m, start) ||
      !project(camera, camera_from_station * edge.end_in_station_m, end))
    return true;
  return distanceToChord(start, end, pixel) <= radius_px + kMostBent * (end - start).norm();
}

/// Place of a segment that is nearest to a pixel once projected; sections are searched, then the
/// best one is narrowed down.
std::optional<Eigen::Vector3d> nearestOnEdge(const Camera& camera, const Pose& camera_from_station,
                                             const ModelEdge& edge, const Eigen::Vector2d& pixel) {
  const auto distance = [&](double t) {
    Eigen::Vector2d seen;
    return project(camera, camera_from_station * edge.at(t), seen) ? (seen - pixel).norm() : 1e9;
  };
  constexpr int kParts = 16;
  int best = 0;
  double least = 1e9;
  for (int i = 0; i <= kParts; ++i) {
    const double current = distance(static_cast<double>(i) / kParts);
    if (current >= least) continue;
    least = current;
    best = i;
  }
  if (least >= 1e9) return {};
  double low = std::max(0.0, (best - 1.0) / kParts);
  double high = std::min(1.0, (best + 1.0) / kParts);
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
  }
  return edge.at(0.5 * (low + high));
}

}  // namespace

MeshSnapper::MeshSnapper(const MeshView& mesh) : mesh_(mesh) {
  if (validateMesh(mesh) != Status::kOk) throw InputError("mesh", "", "is not valid");
  faces_.emplace(mesh_);
  collectEdges();
  collectCircles();
}

Eigen::Vector3d MeshSnapper::vertex(std::int32_t index) const {
  return mesh_.vertices_in_station_m[static_cast<std::size_t>(index)].cast<double>();
}

void MeshSnapper::collectEdges() {
  std::map<Ends, std::vector<std::size_t>> faces_of_edge;
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    if (mesh_.parts[mesh_.part_of_face[f]].fixed_to_camera) continue;  // no place on the station
    const auto& corner = mesh_.faces[f].vertex;
    for (std::size_t i = 0; i < 3; ++i) {
      const Ends ends = {std::min(corner[i], corner[(i + 1) % 3]),
                         std::max(corner[i], corner[(i + 1) % 3])};
      if (ends[0] != ends[1]) faces_of_edge[ends].push_back(f);
    }
  }
  std::set<std::int32_t> corners;
  for (const auto& [ends, faces] : faces_of_edge) {
    const ScenePart& part = mesh_.parts[mesh_.part_of_face[faces[0]]];
    bool salient = faces.size() != 2;
    if (!salient) {
      // Faces need not be oriented alike.
      const double cosine = std::abs(
          faceNormal(mesh_, mesh_.faces[faces[0]]).dot(faceNormal(mesh_, mesh_.faces[faces[1]])));
      salient = cosine < std::cos(part.normal_threshold_rad);
    }
    if (!salient || vertex(ends[0]) == vertex(ends[1])) continue;
    ends_.push_back(ends);
    edges_.push_back({vertex(ends[0]), vertex(ends[1])});
    corners.insert(ends.begin(), ends.end());
  }
  corners_.assign(corners.begin(), corners.end());
}

/// Loops along vertices where just two salient edges meet.
void MeshSnapper::collectCircles() {
  std::map<std::int32_t, std::vector<std::int32_t>> neighbours;
  for (const Ends& ends : ends_) {
    neighbours[ends[0]].push_back(ends[1]);
    neighbours[ends[1]].push_back(ends[0]);
  }
  std::set<std::int32_t> visited;
  for (const auto& [start, around] : neighbours) {
    if (around.size() != 2 || visited.contains(start)) continue;
    std::vector<std::int32_t> loop = {start};
    visited.insert(start);
    std::int32_t before = start;
    std::int32_t after = around[0];
    while (after != start && neighbours[after].size() == 2 && visited.insert(after).second) {
      loop.push_back(after);
      const auto& next = neighbours[after];
      const std::int32_t ahead = next[0] == before ? next[1] : next[0];
      before = after;
      after = ahead;
    }
    if (after == start) addLoop(loop);
  }
}

void MeshSnapper::addLoop(const std::vector<std::int32_t>& loop) {
  if (loop.size() < kSmallestCircle) return;
  Eigen::Matrix3Xd places_m(3, std::ssize(loop));
  for (Eigen::Index i = 0; i < places_m.cols(); ++i)
    places_m.col(i) = vertex(loop[static_cast<std::size_t>(i)]);
  const Eigen::Vector3d mean_m = places_m.rowwise().mean();
  places_m.colwise() -= mean_m;
  const SymmetricEigen<3> axes(places_m * places_m.transpose());
  constexpr double kOnLine = 1e-12;  // share of squares that rounded coordinates leave
  if (!(axes.values[1] > kOnLine * axes.values[2])) return;
  const Eigen::Matrix<double, 3, 2> plane = axes.vectors.rightCols<2>();
  // x^2 + y^2 = 2 a x + 2 b y + c, least squares (Kasa 1976): corners need not be evenly spaced.
  // The sums of x, y and x y are 0, so each unknown is found alone.
  const Eigen::Matrix2Xd in_plane_m = plane.transpose() * places_m;
  const Eigen::VectorXd squares_m2 = in_plane_m.colwise().squaredNorm().transpose();
  const Eigen::Vector2d centre_m =
      (0.5 * (in_plane_m * squares_m2)).cwiseQuotient(axes.values.tail<2>());
  MeshCircle circle;
  circle.normal_in_station = axes.vectors.col(0);
  circle.radius_m = std::sqrt(squares_m2.mean() + centre_m.squaredNorm());
  circle.centre_in_station_m = mean_m + plane * centre_m;
  circle.vertices = loop;
  for (const std::int32_t index : loop) {
    const Eigen::Vector3d offset = vertex(index) - circle.centre_in_station_m;
    const double height_m = offset.dot(circle.normal_in_station);
    const double deviation_m = std::hypot(
        (offset - height_m * circle.normal_in_station).norm() - circle.radius_m, height_m);
    if (!(deviation_m < kCircleDeviation * circle.radius_m)) return;
  }
  circles_.push_back(circle);
}

bool MeshSnapper::seenFrom(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& place_m) const {
  const Eigen::Vector3d ray = place_m - eye_m;
  const double below_m = kOcclusion * faces_->bounds_m().sizes().norm();
  return !faces_->firstHit(eye_m, ray, 1.0 - below_m / std::max(ray.norm(), below_m));
}

std::optional<MeshSnapKind> MeshSnapper::kindAt(const Eigen::Vector3d& point_in_station_m) const {
  constexpr double kSame_m = 1e-5;
  const auto is_here = [&](const Eigen::Vector3d& place_m) {
    return (place_m - point_in_station_m).norm() <= kSame_m;
  };
  if (std::ranges::any_of(corners_, [&](std::int32_t corner) { return is_here(vertex(corner)); }))
    return MeshSnapKind::kVertex;
  if (std::ranges::any_of(
          circles_, [&](const MeshCircle& circle) { return is_here(circle.centre_in_station_m); }))
    return MeshSnapKind::kCircle;
  const bool on_edge = std::ranges::any_of(edges_, [&](const ModelEdge& edge) {
    const Eigen::Vector3d along = edge.end_in_station_m - edge.start_in_station_m;
    const double share =
        (point_in_station_m - edge.start_in_station_m).dot(along) / along.squaredNorm();
    return is_here(edge.start_in_station_m + std::clamp(share, 0.0, 1.0) * along);
  });
  return on_edge ? std::optional(MeshSnapKind::kEdge) : std::nullopt;
}

std::optional<Eigen::Vector3d> MeshSnapper::surfaceAt(const Camera& camera,
                                                      const Pose& camera_from_station,
                                                      const Eigen::Vector2d& pixel) const {
  Ray ray;
  if (!unprojectRay(camera, pixel, ray)) return std::nullopt;
  const Pose station_from_camera = camera_from_station.inverse();
  const Eigen::Vector3d eye_m = station_from_camera * ray.origin_m;
  const Eigen::Vector3d direction = station_from_camera.rotation * ray.direction;
  const auto hit = faces_->firstHit(eye_m, direction);
  if (!hit) return std::nullopt;
  return eye_m + hit->distance * direction;
}

std::vector<MeshSnap> MeshSnapper::near(const Camera& camera, const Pose& camera_from_station,
                                        const Eigen::Vector2d& pixel, double radius_px) const {
  std::vector<MeshSnap> found;
  const auto offer = [&](std::vector<MeshSnap>& offers, MeshSnap snap) {
    if (!project(camera, camera_from_station * snap.point_in_station_m, snap.pixel)) return;
    snap.distance_px = (snap.pixel - pixel).norm();
    if (snap.distance_px <= radius_px) offers.push_back(snap);
  };
  const auto keepNearest = [&](std::vector<MeshSnap>& offers, const auto& seen) {
    std::sort(offers.begin(), offers.end(),
              [](const MeshSnap& a, const MeshSnap& b) { return a.distance_px < b.distance_px; });
    for (std::size_t i = 0; i < std::min(offers.size(), kMostSeenTests); ++i) {
      if (!seen(offers[i])) continue;
      found.push_back(offers[i]);
      return;
    }
  };
  const Eigen::Vector3d eye_m = camera_from_station.inverse().translation_m;
  const auto itself = [&](const MeshSnap& snap) {
    return seenFrom(eye_m, snap.point_in_station_m);
  };
  std::vector<MeshSnap> vertices;
  for (const std::int32_t corner : corners_)
    offer(vertices, {MeshSnapKind::kVertex, vertex(corner), {}, 0.0, {}, 0.0});
  keepNearest(vertices, itself);
  std::vector<MeshSnap> edges;
  for (const ModelEdge& edge : edges_) {
    if (!mayPass(camera, camera_from_station, edge, pixel, radius_px)) continue;
    if (const auto point = nearestOnEdge(camera, camera_from_station, edge, pixel))
      offer(edges, {MeshSnapKind::kEdge, *point, {}, 0.0, edge, 0.0});
  }
  keepNearest(edges, itself);
  std::vector<MeshSnap> circles;
  for (const MeshCircle& circle : circles_)
    offer(circles,
          {MeshSnapKind::kCircle, circle.centre_in_station_m, {}, 0.0, {}, circle.radius_m});
  // A hole's centre lies in the air: half of its rim must be seen.
  keepNearest(circles, [&](const MeshSnap& snap) {
    const auto circle =
        std::find_if(circles_.begin(), circles_.end(), [&](const MeshCircle& mesh_circle) {
          return mesh_circle.centre_in_station_m == snap.point_in_station_m;
        });
    const auto seen =
        std::count_if(circle->vertices.begin(), circle->vertices.end(),
                      [&](std::int32_t index) { return seenFrom(eye_m, vertex(index)); });
    return 2 * static_cast<std::size_t>(seen) >= circle->vertices.size();
  });
  return found;
}

}  // namespace boresight::sessions
