// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_aim.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <QCoreApplication>

#include "sessions/annotation/image_snap.h"

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

namespace {

using sessions::MeshSnap;
using sessions::MeshSnapKind;
using sessions::MeshSnapper;

QString tr(const char* text) { return QCoreApplication::translate("SceneAim", text); }

SceneAim aimOf(const MeshSnapper& mesh, const MeshSnap& snap) {
  SceneAim aim;
  aim.point_in_station_m = snap.point_in_station_m;
  aim.snapped = true;
  switch (snap.kind) {
    case MeshSnapKind::kVertex:
      aim.text = tr("corner");
      break;
    case MeshSnapKind::kEdge:
      aim.edge = snap.edge;
      aim.text = tr("edge");
      break;
    case MeshSnapKind::kCircle:
      for (const sessions::MeshCircle& circle : mesh.circles())
        if (circle.centre_in_station_m == snap.point_in_station_m) aim.circle = circle;
      aim.text = tr("circle centre, radius %1 mm").arg(1e3 * snap.radius_m, 0, 'f', 1);
      break;
  }
  return aim;
}

/// Named points that are seen, the nearest first.
std::vector<SceneAim> landmarkAims(const MeshSnapper& mesh,
                                   const std::vector<sessions::Proposal>& proposals,
                                   const Viewpoint& view, const QPointF& pixel) {
  std::vector<std::pair<double, SceneAim>> aims;
  for (const sessions::Proposal& proposal : proposals) {
    const Eigen::Vector3d& at_m = proposal.landmark.point_in_station_m;
    QPointF at;
    double depth_m = 0.0;
    if (!view.toCanvas(at_m, at, depth_m)) continue;
    const double distance_px = std::hypot(at.x() - pixel.x(), at.y() - pixel.y());
    if (distance_px > kSceneSnap_px || !mesh.seenFrom(view.eyeInStation_m(), at_m)) continue;
    SceneAim aim;
    aim.point_in_station_m = at_m;
    aim.landmark = proposal.landmark;
    aim.snapped = true;
    aim.text = tr("named point %1").arg(QString::fromStdString(proposal.landmark.name));
    aims.emplace_back(distance_px, aim);
  }
  std::sort(aims.begin(), aims.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SceneAim> made;
  for (auto& [distance_px, aim] : aims) made.push_back(std::move(aim));
  return made;
}

}  // namespace

std::optional<SceneAim> sceneAim(const MeshSnapper& mesh,
                                 const std::vector<sessions::Proposal>& proposals,
                                 const Viewpoint& view, const QPointF& pixel,
                                 const SceneAimRules& rules) {
  const Eigen::Vector2d at(pixel.x(), pixel.y());
  std::vector<SceneAim> aims;
  if (!rules.line && rules.snaps) aims = landmarkAims(mesh, proposals, view, pixel);
  if (rules.line || rules.snaps) {
    const auto snaps = sessions::likeliestFirst(
        mesh.near(view.camera, view.view_from_station, at, kSceneSnap_px), kSceneSnap_px);
    for (const MeshSnap& snap : snaps)
      if (!rules.line || snap.edge) aims.push_back(aimOf(mesh, snap));
  }
  if (!aims.empty()) {
    SceneAim aim = aims[static_cast<std::size_t>(rules.turn) % aims.size()];
    aim.found = static_cast<int>(aims.size());
    return aim;
  }
  const auto surface =
      rules.line ? std::nullopt : mesh.surfaceAt(view.camera, view.view_from_station, at);
  if (!surface) return std::nullopt;
  SceneAim aim;
  aim.point_in_station_m = *surface;
  aim.text = tr("surface");
  return aim;
}

QString stationPlaceText(const Eigen::Vector3d& place_m, const QString& what) {
  const Eigen::Vector3d mm = 1e3 * place_m;
  return tr("Station x %1, y %2, z %3 mm (%4)")
      .arg(mm.x(), 0, 'f', 2)
      .arg(mm.y(), 0, 'f', 2)
      .arg(mm.z(), 0, 'f', 2)
      .arg(what);
}

}  // namespace boresight::ui
