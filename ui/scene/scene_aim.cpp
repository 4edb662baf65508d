// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_aim.h"

#include <algorithm>
#include <map>
#include <vector>

#include <QCoreApplication>

#include "sessions/annotation/image_snap.h"
#include "sessions/trace/surface_point.h"

namespace boresight::ui {
namespace {

/// Whether a face lies between the eye and the point, by more than a thousandth of the scene
/// (points on the surface must not hide themselves).
bool isHidden(const SceneContent& content, const Viewpoint& view, const Eigen::Vector3d& at_m,
              const QPointF& pixel) {
  const auto surface = sessions::surfacePointAt(view.camera, content.mesh(), view.view_from_station,
                                                {pixel.x(), pixel.y()});
  const double depth_m = (view.view_from_station * at_m).z();
  return surface && surface->depth_m < depth_m - 1e-3 * content.bounds.diagonal();
}

}  // namespace

int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel) {
  int picked = -1;
  double nearest_px = kTemplatePick_px;
  for (const ScenePoint& point : content.points) {
    if (point.template_index < 0) continue;
    const auto at = view.toCanvas(point.at_m);
    if (!at || distance_px(*at, pixel) > nearest_px || isHidden(content, view, point.at_m, *at))
      continue;
    nearest_px = distance_px(*at, pixel);
    picked = point.template_index;
  }
  return picked;
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
      aim.text = sceneAimText("circle centre, radius %1 mm, z %2 mm")
                     .arg(1e3 * snap.radius_m, 0, 'f', 1)
                     .arg(1e3 * snap.point_in_station_m.z(), 0, 'f', 2);
      break;
  }
  return aim;
}

/// Named points that are seen, the nearest first.
std::vector<SceneAim> landmarkAims(const MeshSnapper& mesh,
                                   const std::vector<sessions::Proposal>& proposals,
                                   const Viewpoint& view, const QPointF& pixel, double radius_px) {
  std::multimap<double, SceneAim> aims;
  for (const sessions::Proposal& proposal : proposals) {
    const Eigen::Vector3d& at_m = proposal.landmark.point_in_station_m;
    const auto at = view.toCanvas(at_m);
    if (!at) continue;
    const double away_px = distance_px(*at, pixel);
    if (away_px > radius_px || !mesh.seenFrom(view.eyeInStation_m(), at_m)) continue;
    SceneAim aim;
    aim.point_in_station_m = at_m;
    aim.landmark = proposal.landmark;
    aim.snapped = true;
    aim.text = sceneAimText("named point %1").arg(QString::fromStdString(proposal.landmark.name));
    aims.emplace(away_px, aim);
  }
  std::vector<SceneAim> scene_aims;
  for (auto& [away_px, aim] : aims) scene_aims.push_back(std::move(aim));
  return scene_aims;
}

}  // namespace

std::optional<SceneAim> sceneAim(const MeshSnapper& mesh,
                                 const std::vector<sessions::Proposal>& proposals,
                                 const Viewpoint& view, const QPointF& pixel,
                                 const AimRules& rules) {
  const Eigen::Vector2d at(pixel.x(), pixel.y());
  std::vector<SceneAim> aims;
  if (!rules.line && rules.snaps)
    aims = landmarkAims(mesh, proposals, view, pixel, rules.radius_px);
  if (rules.line || rules.snaps) {
    const auto snaps = sessions::likeliestFirst(
        mesh.near(view.camera, view.view_from_station, at, rules.radius_px), rules.radius_px);
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
