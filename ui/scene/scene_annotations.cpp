// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_overlay.h"

#include <algorithm>
#include <map>
#include <numbers>

#include <QtWidgets>

#include "ui/annotation/annotation_aim.h"
#include "ui/annotation/annotation_content.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

constexpr double kHalf = 7.5;     ///< of a sign
constexpr double kHidden = 0.35;  ///< opacity
const QColor kSignRim(0, 0, 0, 190);
const QColor kAim(120, 220, 255);

QColor colorOf(const SceneAnnotation& annotation) {
  const QColor color = annotationColor(annotation.state);
  return color.isValid() ? color : layerInfo(LayerId::kPoints).style.color;
}

/// As on the image: a target is complete, a square locked, a diamond waits for its place in the
/// image, a disabled annotation is struck through; a dashed circle is proposed.
MarkShape shapeOf(const SceneAnnotation& annotation) {
  if (annotation.proposed) return MarkShape::kCircle;
  if (!annotation.state.enabled) return MarkShape::kStruck;
  if (!annotation.state.complete) return MarkShape::kDiamond;
  return annotation.locked ? MarkShape::kSquare : MarkShape::kTarget;
}

}  // namespace

SceneAnnotationPainter::SceneAnnotationPainter(QPainter& painter, const Viewpoint& view,
                                               const sessions::MeshSnapper* mesh)
    : painter_(painter), view_(view), mesh_(mesh) {}

bool SceneAnnotationPainter::seen(const Eigen::Vector3d& at_m) const {
  return !mesh_ || mesh_->seenFrom(view_.eyeInStation_m(), at_m);
}

/// In the canvas' coordinates, where pixel (0, 0) has its centre at (0.5, 0.5).
std::optional<QPointF> SceneAnnotationPainter::place(const Eigen::Vector3d& at_m) const {
  const auto at = view_.toCanvas(at_m);
  return at ? std::optional(*at + QPointF(0.5, 0.5)) : std::nullopt;
}

void SceneAnnotationPainter::paintMarks(const std::vector<SceneAnnotation>& annotations) const {
  painter_.save();
  painter_.setRenderHint(QPainter::Antialiasing, true);
  for (const SceneAnnotation& annotation : annotations) {
    if (annotation.edge)
      paintEdge(*annotation.edge, colorOf(annotation), annotation.state.chosen ? 4.5 : 3.0,
                !annotation.state.complete || !annotation.state.enabled);
    paintPoint(annotation);
  }
  painter_.restore();
}

void SceneAnnotationPainter::paintPoint(const SceneAnnotation& annotation) const {
  const auto at = view_.toCanvas(annotation.at_m);
  if (!at) return;
  const bool is_seen = seen(annotation.at_m);
  Mark sign;
  sign.shape = shapeOf(annotation);
  sign.at = *at;
  sign.size_px = 2.0 * kHalf;
  sign.cased = true;
  sign.dashed = annotation.proposed;
  if (is_seen || annotation.state.chosen)
    sign.label = annotationLabel(annotation.id, annotation.state);
  painter_.setOpacity(is_seen ? 1.0 : kHidden);
  for (Mark& each : withState(std::move(sign), annotation.state)) {
    // An edge is drawn itself: it needs its name alone.
    if (annotation.edge && each.shape != MarkShape::kTriangle) each.size_px = 0.0;
    paintMark(painter_, ViewTransform(), each, colorOf(annotation));
  }
  painter_.setOpacity(1.0);
}

/// In pieces, those that a face hides faintly.
void SceneAnnotationPainter::paintEdge(const sessions::ModelEdge& edge, const QColor& color,
                                       double width_px, bool dashed) const {
  constexpr int kPieces = 24;
  const Eigen::Vector3d way = edge.end_in_station_m - edge.start_in_station_m;
  const auto at = [&](double piece) {
    return Eigen::Vector3d(edge.start_in_station_m + piece / kPieces * way);
  };
  for (const QPen& pen : {QPen(kSignRim, width_px + 2.0, Qt::SolidLine, Qt::FlatCap),
                          QPen(color, width_px, Qt::SolidLine, Qt::FlatCap)})
    for (int i = 0; i < kPieces; ++i) {
      if (dashed && i % 3 == 2) continue;
      const auto from = place(at(i));
      const auto to = place(at(i + 1.0));
      if (!from || !to) continue;
      painter_.setPen(pen);
      painter_.setOpacity(seen(at(i + 0.5)) ? 1.0 : kHidden);
      painter_.drawLine(*from, *to);
    }
  painter_.setOpacity(1.0);
}

void SceneAnnotationPainter::paintCircle(const sessions::MeshCircle& circle) const {
  constexpr int kPieces = 72;
  const Eigen::Vector3d across = circle.radius_m * circle.normal_in_station.unitOrthogonal();
  QPolygonF line;
  for (int i = 0; i <= kPieces; ++i) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / kPieces, circle.normal_in_station);
    if (const auto at = place(circle.centre_in_station_m + turn * across)) line << *at;
  }
  painter_.drawPolyline(line);
}

void SceneAnnotationPainter::paintAim(const SceneAim& aim, const QPointF& pointer) const {
  const auto at = place(aim.point_in_station_m);
  if (!at) return;
  painter_.save();
  painter_.setRenderHint(QPainter::Antialiasing, true);
  painter_.setBrush(Qt::NoBrush);
  if (aim.edge) paintEdge(*aim.edge, kAim, 2.5, false);
  for (const QPen& pen : {QPen(kSignRim, 3.6), QPen(kAim, 1.6)}) {
    painter_.setPen(pen);
    if (aim.circle) paintCircle(*aim.circle);
    paintTicks(painter_, *at, 2.5, 10.0);
    if (aim.snapped) painter_.drawPolygon(diamond(*at, kHalf));
  }
  if (aim.snapped) {
    painter_.setPen(QPen(kAim, 1.0, Qt::DotLine));
    painter_.drawLine(pointer + QPointF(0.5, 0.5), *at);
  }
  painter_.restore();
}

void paintOutlined(QPainter& painter, const QPointF& at, const QFont& font, const QString& text,
                   const QColor& color, const QColor& rim) {
  QPainterPath path;
  path.addText(at, font, text);
  painter.setPen(QPen(rim, 3.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.setBrush(Qt::NoBrush);
  painter.drawPath(path);
  painter.setPen(Qt::NoPen);
  painter.setBrush(color);
  painter.drawPath(path);
  painter.setBrush(Qt::NoBrush);
}

namespace {

constexpr double kPick_px = 10.0;

template <class Pair>
SceneAnnotation annotationOf(const Pair& pair, const AnnotationController& controller,
                             const std::map<std::string, double>& outlying) {
  SceneAnnotation annotation;
  annotation.id = pair.id;
  annotation.locked = pair.locked;
  annotation.state = stateOf(pair, controller.selected(), outlying);
  return annotation;
}

/// Of a pixel to an annotation's sign or edge; nothing behind the eye.
std::optional<double> distanceTo(const SceneAnnotation& annotation, const Viewpoint& view,
                                 const QPointF& pixel) {
  const auto from =
      view.toCanvas(annotation.edge ? annotation.edge->start_in_station_m : annotation.at_m);
  const auto to = annotation.edge ? view.toCanvas(annotation.edge->end_in_station_m) : from;
  if (!from || !to) return std::nullopt;
  return distanceToSegment(*from, *to, pixel);
}

}  // namespace

std::vector<SceneAnnotation> sceneAnnotations(const AnnotationController& controller) {
  std::vector<SceneAnnotation> annotations;
  for (const sessions::Proposal& proposal : controller.answer().proposals) {
    SceneAnnotation annotation;
    annotation.id = proposal.landmark.name;
    annotation.at_m = proposal.landmark.point_in_station_m;
    annotation.proposed = true;
    annotation.state.complete = false;
    annotations.push_back(annotation);
  }
  std::map<std::string, double> outlying;
  if (controller.solution()) outlying = controller.solution()->outlierAnnotations();
  for (const sessions::PointPair& point : controller.annotations().points) {
    if (!point.point_in_station_m) continue;
    annotations.push_back(annotationOf(point, controller, outlying));
    annotations.back().at_m = *point.point_in_station_m;
  }
  for (const sessions::LinePair& line : controller.annotations().lines) {
    if (!line.edge) continue;
    annotations.push_back(annotationOf(line, controller, outlying));
    annotations.back().edge = line.edge;
    annotations.back().at_m = 0.5 * (line.edge->start_in_station_m + line.edge->end_in_station_m);
  }
  std::stable_partition(annotations.begin(), annotations.end(),
                        [](const SceneAnnotation& annotation) { return !annotation.state.chosen; });
  return annotations;
}

std::string pickAnnotation(const std::vector<SceneAnnotation>& annotations, const Viewpoint& view,
                           const sessions::MeshSnapper& mesh, const QPointF& pixel) {
  std::string picked;
  double least_px = 2.0 * kPick_px;
  for (const SceneAnnotation& annotation : annotations) {
    if (annotation.proposed) continue;
    const auto away_px = distanceTo(annotation, view, pixel);
    if (!away_px || *away_px > kPick_px) continue;
    const double rank_px = *away_px + (annotation.edge ? kPick_px : 0.0);  // points lie upon lines
    if (rank_px > least_px || !mesh.seenFrom(view.eyeInStation_m(), annotation.at_m)) continue;
    least_px = rank_px;
    picked = annotation.id;
  }
  return picked;
}

}  // namespace boresight::ui
