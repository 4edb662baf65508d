// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QPointF>
#include <QString>

#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/mesh_snap.h"
#include "ui/annotation/annotation_aim.h"
#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

namespace boresight::ui {

inline constexpr double kTemplatePick_px = 9.0;

/// The template nearest to a pixel of the canvas among those that no face hides, within
/// kTemplatePick_px; its index into the iteration's templates, or -1. Picking uses the geometry and
/// reads no pixels back: the result is the same on every screen and without OpenGL.
int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel);

inline constexpr double kSceneSnap_px = 12.0;  ///< of the canvas

/// Target of a click into the scene.
struct SceneAim {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  std::optional<sessions::ModelEdge> edge;     ///< on which it lies
  std::optional<sessions::MeshCircle> circle;  ///< whose centre it is
  std::optional<sessions::Landmark> landmark;  ///< the landmark at this point
  bool snapped = false;
  int found = 0;  ///< number of snap candidates
  QString text;   ///< name of the snap, for the operator
};

/// The target at a pixel of the canvas: named points, then visible corners, edges and centres of
/// circles within the radius, the likeliest first; without one (or with snapping off) the
/// surface. Empty off the station, and for lines away from all edges. Computed from the geometry:
/// the same on every screen, and exact at any magnification.
std::optional<SceneAim> sceneAim(const sessions::MeshSnapper& mesh,
                                 const std::vector<sessions::Proposal>& proposals,
                                 const Viewpoint& view, const QPointF& pixel,
                                 const AimRules& rules);

/// Coordinates of a point of the station in millimetres, and its kind.
QString stationPlaceText(const Eigen::Vector3d& place_m, const QString& what);

}  // namespace boresight::ui
