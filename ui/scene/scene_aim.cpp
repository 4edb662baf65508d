// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_aim.h"

#include <algorithm>
#include <compare>
#include <vector>

#include <QCoreApplication>

#include "sessions/annotation/image_snap.h"

namespace boresight::ui {
namespace {

struct Candidate {
  double away_px = 0.0;
  std::int32_t index = -1;

  auto operator<=>(const Candidate&) const = default;
};

/// Whether a face stands between the eye and the point, by more than a thousandth of the scene
/// (points on the surface must not hide themselves).
bool hidden(const SceneContent& content, const Viewpoint& view, const Eigen::Vector3d& at_m) {
  const Eigen::Vector3d eye_m = view.eyeInStation_m();
  const Eigen::Vector3d ray = at_m - eye_m;
  const double tolerance = 1e-3 * content.bounds.diagonal() / std::max(ray.norm(), 1e-12);
  const auto hit = hitSurface(content.mesh(), eye_m, ray);
  return hit && hit->depth_m < 1.0 - tolerance;
}

void offer(std::vector<Candidate>& candidates, std::size_t index, const std::optional<QPointF>& at,
           const QPointF& pixel, double within_px) {
  if (!at) return;
  const double away_px = distance_px(*at, pixel);
  if (away_px <= within_px) candidates.push_back({away_px, static_cast<std::int32_t>(index)});
}

/// The first candidate that is not hidden, from the nearest on.
template <class Place>
std::int32_t firstVisible(std::vector<Candidate>& candidates, const SceneContent& content,
                          const Viewpoint& view, const Place& place) {
  std::sort(candidates.begin(), candidates.end());
  for (const Candidate& candidate : candidates)
    if (!hidden(content, view, place(candidate.index))) return candidate.index;
  return -1;
}

}  // namespace

int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < content.points.size(); ++i) {
    if (content.points[i].template_index < 0) continue;
    offer(candidates, i, view.toCanvas(content.points[i].at_m), pixel, kTemplatePick_px);
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
  for (std::size_t i = 0; i < mesh.vertices_in_station_m.size(); ++i)
    offer(candidates, i, view.toCanvas(mesh.vertices_in_station_m[i].cast<double>()), pixel,
          kVertexSnap_px);
  // Far away a mesh may have thousands of vertices within reach: the nearest few will do.
  constexpr std::size_t kMostTried = 32;
  if (candidates.size() > kMostTried) {
    std::nth_element(candidates.begin(), candidates.begin() + kMostTried, candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.away_px < b.away_px; });
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

QString sceneAimText(const char* text) { return QCoreApplication::translate("SceneAim", text); }

SceneAim aimOf(const MeshSnapper& mesh, const MeshSnap& snap) {
  SceneAim aim;
  aim.point_in_station_m = snap.point_in_station_m;
  aim.snapped = true;
  switch (snap.kind) {
    case MeshSnapKind::kVertex:
      aim.text = sceneAimText("corner");
      break;
    case MeshSnapKind::kEdge:
      aim.edge = snap.edge;
      aim.text = sceneAimText("edge");
      break;
    case MeshSnapKind::kCircle:
      for (const sessions::MeshCircle& circle : mesh.circles())
        if (circle.centre_in_station_m == snap.point_in_station_m) aim.circle = circle;
      aim.text = sceneAimText("circle centre, radius %1 mm").arg(1e3 * snap.radius_m, 0, 'f', 1);
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
    const auto at = view.toCanvas(at_m);
    if (!at) continue;
    const double away_px = distance_px(*at, pixel);
    if (away_px > kSceneSnap_px || !mesh.seenFrom(view.eyeInStation_m(), at_m)) continue;
    SceneAim aim;
    aim.point_in_station_m = at_m;
    aim.landmark = proposal.landmark;
    aim.snapped = true;
    aim.text = sceneAimText("named point %1").arg(QString::fromStdString(proposal.landmark.name));
    aims.emplace_back(away_px, aim);
  }
  std::sort(aims.begin(), aims.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SceneAim> made;
  for (auto& [away_px, aim] : aims) made.push_back(std::move(aim));
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
  aim.text = sceneAimText("surface");
  return aim;
}

QString stationPlaceText(const Eigen::Vector3d& place_m, const QString& what) {
  const Eigen::Vector3d mm = 1e3 * place_m;
  return sceneAimText("Station x %1, y %2, z %3 mm (%4)")
      .arg(mm.x(), 0, 'f', 2)
      .arg(mm.y(), 0, 'f', 2)
      .arg(mm.z(), 0, 'f', 2)
      .arg(what);
}

}  // namespace boresight::ui
