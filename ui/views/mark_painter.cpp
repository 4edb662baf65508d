// SPDX-License-Identifier: Apache-2.0
#include "ui/views/mark_painter.h"

#include <algorithm>
#include <cmath>

#include <QLineF>

namespace boresight::ui {
namespace {

double length(const QPointF& vector) { return std::hypot(vector.x(), vector.y()); }

void paintArrow(QPainter& painter, const QPointF& from, const QPointF& to) {
  painter.drawLine(from, to);
  const QPointF way = to - from;
  const double long_px = length(way);
  if (long_px < 1.0) {
    painter.drawPoint(to);
    return;
  }
  const QPointF along = way / long_px;
  const QPointF across(-along.y(), along.x());
  const double head_px = std::min(8.0, 0.5 * long_px);
  painter.drawLine(to, to - along * head_px + across * (0.4 * head_px));
  painter.drawLine(to, to - along * head_px - across * (0.4 * head_px));
}

double distanceToSegment(const QPointF& from, const QPointF& to, const QPointF& place) {
  const QPointF way = to - from;
  const double squared = QPointF::dotProduct(way, way);
  const double share =
      squared > 0.0 ? std::clamp(QPointF::dotProduct(place - from, way) / squared, 0.0, 1.0) : 0.0;
  return length(place - (from + way * share));
}

}  // namespace

void paintMark(QPainter& painter, const ViewTransform& transform, const Mark& mark,
               const QColor& layer_color) {
  QPen pen(mark.color.isValid() ? mark.color : layer_color);
  pen.setWidthF(1.5);
  pen.setCosmetic(true);
  if (mark.dashed) pen.setDashPattern({3.0, 3.0});
  painter.setPen(pen);
  painter.setBrush(Qt::NoBrush);
  const QPointF at = transform.toWidget(mark.at);
  const double half = 0.5 * mark.size_px;
  switch (mark.shape) {
    case MarkShape::kCross:
      painter.drawLine(at - QPointF(half, 0.0), at + QPointF(half, 0.0));
      painter.drawLine(at - QPointF(0.0, half), at + QPointF(0.0, half));
      break;
    case MarkShape::kCircle:
      painter.drawEllipse(at, half, half);
      break;
    case MarkShape::kSquare:
      painter.drawRect(QRectF(at - QPointF(half, half), at + QPointF(half, half)));
      break;
    case MarkShape::kDiamond:
      painter.drawPolygon(QPolygonF({at + QPointF(0.0, -half), at + QPointF(half, 0.0),
                                     at + QPointF(0.0, half), at + QPointF(-half, 0.0)}));
      break;
    case MarkShape::kArrow:
      paintArrow(painter, at, transform.toWidget(mark.to));
      break;
    case MarkShape::kRectangle:
      painter.drawRect(transform.toWidget(mark.area));
      break;
  }
  if (!mark.label.isEmpty()) painter.drawText(at + QPointF(half + 3.0, -half), mark.label);
}

double distanceTo(const ViewTransform& transform, const Mark& mark, const QPointF& widget) {
  const QPointF at = transform.toWidget(mark.at);
  if (mark.shape == MarkShape::kArrow)
    return distanceToSegment(at, transform.toWidget(mark.to), widget);
  if (mark.shape == MarkShape::kRectangle) {
    const QRectF area = transform.toWidget(mark.area);
    return std::min(std::min(distanceToSegment(area.topLeft(), area.topRight(), widget),
                             distanceToSegment(area.topRight(), area.bottomRight(), widget)),
                    std::min(distanceToSegment(area.bottomRight(), area.bottomLeft(), widget),
                             distanceToSegment(area.bottomLeft(), area.topLeft(), widget)));
  }
  return std::max(0.0, length(widget - at) - 0.5 * mark.size_px);
}

}  // namespace boresight::ui
