// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/aim_painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <QFontMetricsF>
#include <QPolygonF>

namespace boresight::ui {
namespace {

constexpr double kHalf = 7.0;     ///< of the place's sign
constexpr double kNormal = 26.0;  ///< length of an edge's normal
constexpr double kBeside = 16.0;
constexpr double kPadding = 6.0;
const QColor kImageColor(255, 255, 255);
const QColor kStationColor(120, 220, 255);
const QColor kRim(0, 0, 0, 170);

QPointF toWidget(const ViewTransform& transform, const Eigen::Vector2d& pixel) {
  return transform.toWidget(QPointF(pixel.x(), pixel.y()));
}

QPolygonF ellipseOnWidget(const ViewTransform& transform, const sessions::EllipseSnap& ellipse) {
  constexpr int kPieces = 72;
  QPolygonF line;
  const Eigen::Vector2d along(std::cos(ellipse.angle_rad), std::sin(ellipse.angle_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPieces;
    line << toWidget(transform, ellipse.centre +
                                    ellipse.half_axes_px.x() * std::cos(angle) * along +
                                    ellipse.half_axes_px.y() * std::sin(angle) * across);
  }
  return line;
}

/// A cross turned by 45 degrees with a free middle, in a diamond when it is snapped.
void paintPlace(QPainter& painter, const QPointF& at, bool snapped) {
  for (const QPointF& way :
       {QPointF(1.0, 0.0), QPointF(-1.0, 0.0), QPointF(0.0, 1.0), QPointF(0.0, -1.0)})
    painter.drawLine(at + 2.5 * way, at + (kHalf + 3.0) * way);
  if (snapped)
    painter.drawPolygon(QPolygonF({at + QPointF(0.0, -kHalf), at + QPointF(kHalf, 0.0),
                                   at + QPointF(0.0, kHalf), at + QPointF(-kHalf, 0.0)}));
}

void paintFound(QPainter& painter, const ViewTransform& transform, const MarkAim& aim) {
  const QPointF at = toWidget(transform, aim.pixel);
  if (aim.snap && aim.snap->kind == sessions::ImageSnapKind::kEllipse)
    painter.drawPolyline(ellipseOnWidget(transform, aim.snap->ellipse));
  if (aim.snap && aim.snap->kind == sessions::ImageSnapKind::kEdge) {
    const QPointF normal(aim.snap->edge.normal.x(), aim.snap->edge.normal.y());
    const QPointF along(-normal.y(), normal.x());
    painter.drawLine(at - kNormal * along, at + kNormal * along);
    painter.drawLine(at + kHalf * normal, at + kNormal * normal);  // towards the bright side
  }
  QPolygonF edge;
  for (const Eigen::Vector2d& pixel : aim.edge_on_image) edge << toWidget(transform, pixel);
  if (edge.size() > 1) painter.drawPolyline(edge);
}

}  // namespace

void paintAim(QPainter& painter, const ViewTransform& transform, const MarkAim& aim,
              const QPointF& pointer) {
  if (aim.side == AimSide::kNone) return;
  const QPointF at = toWidget(transform, aim.pixel);
  const QColor color = aim.side == AimSide::kImage ? kImageColor : kStationColor;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setBrush(Qt::NoBrush);
  for (const QPen& pen : {QPen(kRim, 3.2), QPen(color, 1.4)}) {
    painter.setPen(pen);
    paintFound(painter, transform, aim);
    paintPlace(painter, at, aim.found > 0);
  }
  if (aim.found > 0) {
    painter.setPen(QPen(color, 1.0, Qt::DotLine));
    painter.drawLine(transform.toWidget(pointer), at);
  }
  painter.restore();
}

QRectF paintBox(QPainter& painter, const QPointF& top_left, const QString& text, double room) {
  const QFontMetricsF metrics(painter.font());
  const QSizeF size(metrics.horizontalAdvance(text) + 2.0 * kPadding, metrics.height() + 4.0);
  const QRectF box(top_left, size + QSizeF(room, 0.0));
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0, 0, 0, 190));
  painter.drawRoundedRect(box, 3.0, 3.0);
  painter.setPen(QColor(255, 255, 255));
  painter.drawText(QRectF(top_left, size), Qt::AlignCenter, text);
  painter.restore();
  return box;
}

void paintNote(QPainter& painter, const QRectF& area, const QRectF& taken, const QPointF& beside,
               const QString& text) {
  if (text.isEmpty()) return;
  const QFontMetricsF metrics(painter.font());
  const QSizeF size(metrics.horizontalAdvance(text) + 2.0 * kPadding, metrics.height() + 4.0);
  QRectF box(beside + QPointF(kBeside, kBeside), size);
  if (box.right() > area.right() || box.intersects(taken)) box.moveRight(beside.x() - kBeside);
  if (box.left() < area.left()) box.moveTopLeft(QPointF(area.left(), beside.y() + 2.0 * kBeside));
  if (box.bottom() > area.bottom()) box.moveBottom(beside.y() - kBeside);
  paintBox(painter, box.topLeft(), text);
}

}  // namespace boresight::ui
