// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_picker.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace boresight::ui {
namespace {

struct Candidate {
  double distance_px = 0.0;
  std::int32_t index = -1;
};

double distance(const QPointF& a, const QPointF& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

/// Whether a face stands between the eye and the point, by more than a thousandth of the scene
/// (points on the surface must not hide themselves).
bool hidden(const SceneContent& content, const Viewpoint& view, const Eigen::Vector3d& at_m) {
  const Eigen::Vector3d eye_m = view.eyeInStation_m();
  const Eigen::Vector3d ray = at_m - eye_m;
  const double tolerance = 1e-3 * content.bounds.diagonal() / std::max(ray.norm(), 1e-12);
  const auto hit = hitSurface(content.mesh(), eye_m, ray);
  return hit && hit->depth_m < 1.0 - tolerance;
}

/// The first candidate that is not hidden, from the nearest on.
template <class Place>
std::int32_t firstVisible(std::vector<Candidate>& candidates, const SceneContent& content,
                          const Viewpoint& view, const Place& place) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_px != b.distance_px ? a.distance_px < b.distance_px : a.index < b.index;
  });
  for (const Candidate& candidate : candidates)
    if (!hidden(content, view, place(candidate.index))) return candidate.index;
  return -1;
}

}  // namespace

int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < content.points.size(); ++i) {
    QPointF at;
    double depth_m = 0.0;
    if (content.points[i].template_index < 0) continue;
    if (!view.toCanvas(content.points[i].at_m, at, depth_m)) continue;
    const double distance_px = distance(at, pixel);
    if (distance_px <= kTemplatePick_px)
      candidates.push_back({distance_px, static_cast<std::int32_t>(i)});
  }
  const auto place = [&](std::int32_t i) {
    return content.points[static_cast<std::size_t>(i)].at_m;
  };
  const std::int32_t picked = firstVisible(candidates, content, view, place);
  return picked < 0 ? -1 : content.points[static_cast<std::size_t>(picked)].template_index;
}

std::optional<MeshPick> pickMesh(const SceneContent& content, const Viewpoint& view,
                                 const QPointF& pixel) {
  const MeshView mesh = content.mesh();
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < mesh.vertices_in_station_m.size(); ++i) {
    QPointF at;
    double depth_m = 0.0;
    if (!view.toCanvas(mesh.vertices_in_station_m[i].cast<double>(), at, depth_m)) continue;
    const double distance_px = distance(at, pixel);
    if (distance_px <= kVertexSnap_px)
      candidates.push_back({distance_px, static_cast<std::int32_t>(i)});
  }
  // Far away a mesh may have thousands of vertices within reach: the nearest few will do.
  constexpr std::size_t kMostTried = 32;
  if (candidates.size() > kMostTried) {
    std::nth_element(
        candidates.begin(), candidates.begin() + kMostTried, candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.distance_px < b.distance_px; });
    candidates.resize(kMostTried);
  }
  const auto place = [&](std::int32_t i) -> Eigen::Vector3d {
    return mesh.vertices_in_station_m[static_cast<std::size_t>(i)].cast<double>();
  };
  const std::int32_t vertex = firstVisible(candidates, content, view, place);
  if (vertex >= 0) return MeshPick{place(vertex), vertex};
  const auto hit = hitSurface(mesh, view.eyeInStation_m(), view.rayInStation(pixel));
  if (!hit) return std::nullopt;
  return MeshPick{hit->at_m, -1};
}

}  // namespace boresight::ui
