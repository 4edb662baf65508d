// SPDX-License-Identifier: Apache-2.0
#include "ui/views/tool_preview.h"

#include <QPolygonF>

namespace boresight::ui {
namespace {

constexpr double kCorner = 3.5;

void paintTrack(QPainter& painter, const QPolygonF& track, double width, const QColor& color) {
  painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  if (track.size() == 1) {
    painter.drawPoint(track.front());
  } else {
    painter.drawPolyline(track);
  }
}

/// How large the brush is: dark under bright, seen on any image.
void paintRim(QPainter& painter, const QPointF& at, double radius, const QColor& color) {
  QColor line = color;
  line.setAlphaF(1.0);
  painter.setBrush(Qt::NoBrush);
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 3.0), QPen(line, 1.5)}) {
    painter.setPen(pen);
    painter.drawEllipse(at, radius, radius);
  }
}

void paintOutline(QPainter& painter, const QPolygonF& outline, const QColor& color, bool filled) {
  QColor line = color;
  line.setAlphaF(1.0);
  // Dark under bright: seen on any image.
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 3.0), QPen(line, 1.5)}) {
    painter.setPen(pen);
    painter.setBrush(filled ? QBrush(color) : QBrush(Qt::NoBrush));
    if (filled) {
      painter.drawPolygon(outline);
    } else {
      painter.drawPolyline(outline);
    }
  }
  painter.setBrush(line);
  if (!filled)
    for (const QPointF& corner : outline)
      painter.drawRect(
          QRectF(corner - QPointF(kCorner, kCorner), corner + QPointF(kCorner, kCorner)));
  painter.setBrush(Qt::NoBrush);
}

}  // namespace

void paintPreview(QPainter& painter, const ViewTransform& transform, const ToolPreview& preview) {
  if (preview.points.empty()) return;
  QPolygonF points;
  for (const QPointF& pixel : preview.points) points << transform.toWidget(pixel);
  painter.setRenderHint(QPainter::Antialiasing, true);
  if (preview.radius_px > 0.0) {
    const double radius = preview.radius_px * transform.scale();
    paintTrack(painter, points, 2.0 * radius, preview.color);
    paintRim(painter, points.back(), radius, preview.color);
  } else {
    paintOutline(painter, points, preview.color, preview.filled);
  }
  painter.setRenderHint(QPainter::Antialiasing, false);
}

}  // namespace boresight::ui
