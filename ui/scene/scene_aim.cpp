// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_aim.h"

#include <algorithm>
#include <cmath>

#include <QCoreApplication>

#include "sessions/annotation/snap_choice.h"

namespace boresight::ui {
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
