// SPDX-License-Identifier: Apache-2.0
// Where a click would place an annotation, and how that is drawn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QPainter>
#include <QString>

#include "sessions/annotation/image_snap.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/session/case_run.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// Which side of a pair a click gives.
enum class AimSide : std::uint8_t { kNone, kImage, kStation };

/// What a click would annotate: a place of the image, or a place (or an edge) of the station.
struct AnnotationAim {
  AimSide side = AimSide::kNone;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the station: where the pose puts it
  std::optional<Eigen::Vector3d> point_in_station_m;
  std::optional<sessions::ModelEdge> edge;     ///< of the station
  std::vector<Eigen::Vector2d> edge_on_image;  ///< where the pose puts it
  std::optional<sessions::ImageSnap> snap;     ///< of the image; nothing: the pointer's own place
  QString text;                                ///< what it snaps to, for the operator
  int found = 0;                               ///< how many things there were to snap to
  int chosen = 0;                              ///< which of these it is; by turns
};

/// How an aim may snap.
struct AimRules {
  bool snaps = true;
  bool line = false;       ///< aims for lines: edges first
  double radius_px = 4.0;  ///< image pixels
  int turn = 0;            ///< how often the operator asked for another one
};

/// Image pixels within which things are snapped to, at this number of screen pixels per image
/// pixel.
double snapRadius_px(double scale);

AnnotationAim aimAtImage(const sessions::LoadedCase& loaded_case, const Eigen::Vector2d& pointer,
                         const AimRules& rules);

/// `snaps`: what of the mesh is near the pointer under the pose, the likeliest first. Without one
/// (or refused) it is the surface under the pointer; lines need an edge.
AnnotationAim aimAtStation(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station,
                           const Eigen::Vector2d& pointer, std::vector<sessions::MeshSnap> snaps,
                           const AimRules& rules);

/// Draws where a click would go and what it snaps to: the place, the way from the pointer, the
/// ellipse or the edge that was found. Seen on any image: bright over a dark rim.
void paintAim(QPainter& painter, const ViewTransform& transform, const AnnotationAim& aim,
              const QPointF& pointer);

/// A sentence on a dark ground with room at its right; where it was drawn.
QRectF paintBox(QPainter& painter, const QPointF& top_left, const QString& text, double room = 0.0);

/// A sentence next to a position of the widget, on a dark ground, kept inside `area` and clear of
/// `taken`.
void paintNote(QPainter& painter, const QRectF& area, const QRectF& taken, const QPointF& anchor,
               const QString& text);

}  // namespace boresight::ui
