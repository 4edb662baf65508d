// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QPointF>
#include <QString>

#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/mesh_snap.h"
#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

namespace boresight::ui {

inline constexpr double kTemplatePick_px = 9.0;

/// The template nearest to a pixel of the canvas among those that no face hides, within
/// kTemplatePick_px; its index into the iteration's templates, or -1. Picking computes, and does
/// not read pixels back: it works alike on every screen and without OpenGL.
int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel);

inline constexpr double kSceneSnap_px = 12.0;  ///< of the canvas

/// How a place of the station may be aimed at.
struct SceneAimRules {
  bool snaps = true;
  bool line = false;  ///< an edge, or nothing
  int turn = 0;       ///< how often the operator asked for another thing to snap to
};

/// What a click into the scene would annotate.
struct SceneAim {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  std::optional<sessions::ModelEdge> edge;     ///< that it lies on
  std::optional<sessions::MeshCircle> circle;  ///< whose centre it is
  std::optional<sessions::Landmark> landmark;  ///< that it is
  bool snapped = false;
  int found = 0;  ///< how many things there were to snap to
  QString text;   ///< what it snaps to, for the operator
};

/// What is under a pixel of the canvas: named points, then corners, edges and centres of circles
/// that are seen from there within kSceneSnap_px, the likeliest first; without one (or where snaps
/// are refused) the surface. Nothing off the station, and for lines away from all edges.
/// Computed from the geometry: alike on every screen, and exact at any magnification.
std::optional<SceneAim> sceneAim(const sessions::MeshSnapper& mesh,
                                 const std::vector<sessions::Proposal>& proposals,
                                 const Viewpoint& view, const QPointF& pixel,
                                 const SceneAimRules& rules);

/// A place of the station in millimetres, and what is there.
QString stationPlaceText(const Eigen::Vector3d& place_m, const QString& what);

}  // namespace boresight::ui
