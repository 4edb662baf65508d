// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_overlay.h"

#include <algorithm>
#include <map>
#include <numbers>

#include <QtWidgets>

#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/mark_aim.h"
#include "ui/annotation/mark_content.h"
#include "ui/views/layer.h"

namespace boresight::ui {
namespace {

constexpr double kHalf = 7.5;  ///< of a sign
constexpr double kChosenHalf = 13.0;
constexpr double kHidden = 0.35;  ///< opacity
const QColor kSignRim(0, 0, 0, 190);
const QColor kAim(120, 220, 255);

QString markText(const char* text) { return QCoreApplication::translate("SceneMarks", text); }

QColor colorOf(const SceneMark& mark) {
  if (!mark.enabled) return kDisabledMark;
  if (mark.outlier > 0.0) return kOutlierMark;
  if (mark.chosen) return kChosenMark;
  return layerInfo(LayerId::kPoints).style.color;
}

QString nameOf(const SceneMark& mark) {
  const QString id = QString::fromStdString(mark.id);
  if (mark.proposed) return markText("%1 ?").arg(id);
  if (!mark.enabled) return markText("%1 (off)").arg(id);
  if (!mark.complete)
    return (mark.chosen ? markText("%1: not in the image yet") : markText("%1 ?")).arg(id);
  if (mark.outlier > 0.0) return markText("%1 ! %2 sigma").arg(id).arg(mark.outlier, 0, 'f', 1);
  return id;
}

QPolygonF triangle(const QPointF& at, double half) {
  return {{at + QPointF(0.0, -1.2 * half), at + QPointF(1.1 * half, 0.75 * half),
           at + QPointF(-1.1 * half, 0.75 * half)}};
}

}  // namespace

SceneMarkPainter::SceneMarkPainter(QPainter& painter, const Viewpoint& view,
                                   const sessions::MeshSnapper* mesh)
    : painter_(painter), view_(view), mesh_(mesh) {}

bool SceneMarkPainter::seen(const Eigen::Vector3d& at_m) const {
  return !mesh_ || mesh_->seenFrom(view_.eyeInStation_m(), at_m);
}

/// In the canvas' coordinates, where pixel (0, 0) has its centre at (0.5, 0.5).
std::optional<QPointF> SceneMarkPainter::place(const Eigen::Vector3d& at_m) const {
  const auto at = view_.toCanvas(at_m);
  return at ? std::optional(*at + QPointF(0.5, 0.5)) : std::nullopt;
}

void SceneMarkPainter::paintMarks(const std::vector<SceneMark>& marks) const {
  painter_.save();
  painter_.setRenderHint(QPainter::Antialiasing, true);
  for (const SceneMark& mark : marks) {
    if (mark.edge)
      paintEdge(*mark.edge, colorOf(mark), mark.chosen ? 4.5 : 3.0,
                !mark.complete || !mark.enabled);
    paintPoint(mark);
  }
  painter_.restore();
}

void SceneMarkPainter::paintPoint(const SceneMark& mark) const {
  const auto at = place(mark.at_m);
  if (!at) return;
  const double opacity = seen(mark.at_m) ? 1.0 : kHidden;
  painter_.setOpacity(opacity);
  painter_.setBrush(Qt::NoBrush);
  const double width_px = mark.chosen ? 2.4 : 1.6;
  for (const QPen& pen : {QPen(kSignRim, width_px + 2.0), QPen(colorOf(mark), width_px)}) {
    painter_.setPen(pen);
    if (!mark.edge) paintSign(mark, *at);
    if (mark.chosen && !mark.edge) painter_.drawEllipse(*at, kChosenHalf, kChosenHalf);
    if (mark.outlier > 0.0) painter_.drawPolygon(triangle(*at, 2.0 * kHalf));
  }
  if (opacity == 1.0 || mark.chosen) paintName(mark, *at);
  painter_.setOpacity(1.0);
}

/// As on the image: a target is complete, a square locked, a diamond waits for its place in the
/// image, what is off is struck through; a dotted circle is proposed.
void SceneMarkPainter::paintSign(const SceneMark& mark, const QPointF& at) const {
  if (mark.proposed) {
    QPen pen = painter_.pen();
    pen.setStyle(Qt::DotLine);
    painter_.setPen(pen);
    painter_.drawEllipse(at, kHalf, kHalf);
  } else if (!mark.enabled) {
    painter_.drawEllipse(at, kHalf, kHalf);
    painter_.drawLine(at + QPointF(-kHalf, kHalf), at + QPointF(kHalf, -kHalf));
  } else if (!mark.complete) {
    painter_.drawPolygon(diamond(at, kHalf));
  } else if (mark.locked) {
    painter_.drawRect(QRectF(at - QPointF(kHalf, kHalf), at + QPointF(kHalf, kHalf)));
  } else {
    painter_.drawEllipse(at, 0.7 * kHalf, 0.7 * kHalf);
    paintTicks(painter_, at, 0.35 * kHalf, 1.3 * kHalf);
  }
}

/// In pieces, those that a face hides faintly.
void SceneMarkPainter::paintEdge(const sessions::ModelEdge& edge, const QColor& color,
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

void SceneMarkPainter::paintName(const SceneMark& mark, const QPointF& at) const {
  QFont font = painter_.font();
  font.setBold(mark.chosen);
  paintOutlined(painter_, at + QPointF(kHalf + 6.0, -kHalf), font, nameOf(mark), colorOf(mark),
                kSignRim);
}

void SceneMarkPainter::paintCircle(const sessions::MeshCircle& circle) const {
  constexpr int kPieces = 72;
  const Eigen::Vector3d across = circle.radius_m * circle.normal_in_station.unitOrthogonal();
  QPolygonF line;
  for (int i = 0; i <= kPieces; ++i) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / kPieces, circle.normal_in_station);
    if (const auto at = place(circle.centre_in_station_m + turn * across)) line << *at;
  }
  painter_.drawPolyline(line);
}

void SceneMarkPainter::paintAim(const SceneAim& aim, const QPointF& pointer) const {
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

void paintSceneNote(QPainter& painter, const QRectF& area, const QPointF& beside,
                    const QString& text) {
  constexpr double kBeside = 16.0;
  const QFontMetricsF metrics(painter.font());
  QRectF box(beside + QPointF(kBeside, kBeside),
             QSizeF(metrics.horizontalAdvance(text) + 12.0, metrics.height() + 4.0));
  if (box.right() > area.right()) box.moveRight(std::max(beside.x() - kBeside, box.width()));
  if (box.bottom() > area.bottom()) box.moveBottom(beside.y() - kBeside);
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0, 0, 0, 200));
  painter.drawRoundedRect(box, 3.0, 3.0);
  painter.setPen(QColor(255, 255, 255));
  painter.drawText(box, Qt::AlignCenter, text);
  painter.restore();
}

namespace {

constexpr double kPick_px = 10.0;

template <class Pair>
SceneMark markOf(const Pair& pair, const AnnotationController& annotation,
                 const std::map<std::string, double>& outlying) {
  SceneMark mark;
  mark.id = pair.id;
  mark.complete = pair.complete();
  mark.enabled = pair.enabled;
  mark.locked = pair.locked;
  mark.chosen = pair.id == annotation.selected();
  const auto outlier = outlying.find(pair.id);
  if (pair.used() && outlier != outlying.end()) mark.outlier = outlier->second;
  return mark;
}

/// Of a pixel to a mark's sign or edge; nothing behind the eye.
std::optional<double> distanceTo(const SceneMark& mark, const Viewpoint& view,
                                 const QPointF& pixel) {
  const auto from = view.toCanvas(mark.edge ? mark.edge->start_in_station_m : mark.at_m);
  const auto to = mark.edge ? view.toCanvas(mark.edge->end_in_station_m) : from;
  if (!from || !to) return std::nullopt;
  const QPointF way = *to - *from;
  const double squared = QPointF::dotProduct(way, way);
  const double share =
      squared > 0.0 ? std::clamp(QPointF::dotProduct(pixel - *from, way) / squared, 0.0, 1.0) : 0.0;
  return distance_px(*from + share * way, pixel);
}

}  // namespace

std::vector<SceneMark> sceneMarks(const AnnotationController& annotation) {
  std::vector<SceneMark> marks;
  for (const sessions::Proposal& proposal : annotation.proposals()) {
    SceneMark mark;
    mark.id = proposal.landmark.name;
    mark.at_m = proposal.landmark.point_in_station_m;
    mark.proposed = true;
    marks.push_back(mark);
  }
  std::map<std::string, double> outlying;
  if (annotation.solution()) outlying = annotation.solution()->standingOut();
  for (const sessions::PointPair& point : annotation.marks().points) {
    if (!point.point_in_station_m) continue;
    marks.push_back(markOf(point, annotation, outlying));
    marks.back().at_m = *point.point_in_station_m;
  }
  for (const sessions::LinePair& line : annotation.marks().lines) {
    if (!line.edge) continue;
    marks.push_back(markOf(line, annotation, outlying));
    marks.back().edge = line.edge;
    marks.back().at_m = 0.5 * (line.edge->start_in_station_m + line.edge->end_in_station_m);
  }
  std::stable_partition(marks.begin(), marks.end(),
                        [](const SceneMark& mark) { return !mark.chosen; });
  return marks;
}

std::string pickMark(const std::vector<SceneMark>& marks, const Viewpoint& view,
                     const sessions::MeshSnapper& mesh, const QPointF& pixel) {
  std::string picked;
  double least_px = 2.0 * kPick_px;
  for (const SceneMark& mark : marks) {
    if (mark.proposed) continue;
    const auto away_px = distanceTo(mark, view, pixel);
    if (!away_px || *away_px > kPick_px) continue;
    const double rank_px = *away_px + (mark.edge ? kPick_px : 0.0);  // points lie upon lines
    if (rank_px > least_px || !mesh.seenFrom(view.eyeInStation_m(), mark.at_m)) continue;
    least_px = rank_px;
    picked = mark.id;
  }
  return picked;
}

}  // namespace boresight::ui
