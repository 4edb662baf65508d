// SPDX-License-Identifier: Apache-2.0
// The target of a click that would place an annotation, and its drawing.
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

/// The side of a pair that a click sets.
enum class AimSide : std::uint8_t { kNone, kImage, kStation };

/// Target of a click: a position in the image, or a point (or an edge) of the station.
struct AnnotationAim {
  AimSide side = AimSide::kNone;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< for the station: its projection
  std::optional<Eigen::Vector3d> point_in_station_m;
  std::optional<sessions::ModelEdge> edge;     ///< of the station
  std::vector<Eigen::Vector2d> edge_on_image;  ///< projection of the edge
  std::optional<sessions::ImageSnap> snap;     ///< of the image; empty: the pointer's position
  QString text;                                ///< name of the snap, for the operator
  int found = 0;                               ///< number of snap candidates
  int chosen = 0;                              ///< index of the candidate used
};

/// How an aim may snap.
struct AimRules {
  bool snaps = true;
  bool line = false;       ///< aims for lines: edges first
  double radius_px = 4.0;  ///< image pixels
  int turn = 0;            ///< number of requests for another candidate
};

/// Snap radius in image pixels, at this number of screen pixels per image pixel.
double snapRadius_px(double scale);

AnnotationAim aimAtImage(const sessions::LoadedCase& loaded_case, const Eigen::Vector2d& pointer,
                         const AimRules& rules);

/// `snaps`: features of the mesh near the pointer under the pose, the likeliest first. Without one
/// (or with snapping off) the target is the surface under the pointer; lines need an edge.
AnnotationAim aimAtStation(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station,
                           const Eigen::Vector2d& pointer, std::vector<sessions::MeshSnap> snaps,
                           const AimRules& rules);

/// Draws the target of a click and its snap: the position, a line from the pointer, the ellipse or
/// the edge that was found. Bright over a dark rim, to be visible on any image.
void paintAim(QPainter& painter, const ViewTransform& transform, const AnnotationAim& aim,
              const QPointF& pointer);

/// Draws a sentence on a dark background with room at its right; returns its rectangle.
QRectF paintBox(QPainter& painter, const QPointF& top_left, const QString& text, double room = 0.0);

/// Draws a sentence next to a position of the widget, on a dark background, inside `area` and
/// outside `taken`.
void paintNote(QPainter& painter, const QRectF& area, const QRectF& taken, const QPointF& anchor,
               const QString& text);

}  // namespace boresight::ui
