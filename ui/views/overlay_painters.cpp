// SPDX-License-Identifier: Apache-2.0
#include "ui/views/overlay_painters.h"

#include <algorithm>
#include <cmath>

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/views/line_painter.h"

namespace boresight::ui {
namespace {

constexpr double kGap = 9.0;
const QColor kRim(0, 0, 0, 150);

}  // namespace

void paintLoupeCross(QPainter& painter, const QSizeF& loupe) {
  const QPointF middle(0.5 * loupe.width(), 0.5 * loupe.height());
  painter.setBrush(Qt::NoBrush);
  for (const QPen& pen : {QPen(kRim, 3.0), QPen(kLoupeCrossColor, 1.0)}) {
    painter.setPen(pen);
    painter.drawLine(QPointF(0.0, middle.y()), middle - QPointF(kGap, 0.0));
    painter.drawLine(middle + QPointF(kGap, 0.0), QPointF(loupe.width(), middle.y()));
    painter.drawLine(QPointF(middle.x(), 0.0), middle - QPointF(0.0, kGap));
    painter.drawLine(middle + QPointF(0.0, kGap), QPointF(middle.x(), loupe.height()));
  }
}

namespace {

const QColor kCasing(0, 0, 0, 170);
const QColor kLabelGround(0, 0, 0, 130);
constexpr double kStripFill = 0.45;

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

/// A strip whose outline goes along one side and back along the other: its ends stay open, as it
/// continues in the next one.
void paintStrip(QPainter& painter, const QPolygonF& outline) {
  QColor fill = painter.pen().color();
  fill.setAlphaF(kStripFill);
  const QPen sides = painter.pen();
  painter.setPen(Qt::NoPen);
  painter.setBrush(fill);
  painter.drawPolygon(outline);
  painter.setPen(sides);
  painter.setBrush(Qt::NoBrush);
  const auto half = outline.size() / 2;
  painter.drawPolyline(outline.mid(0, half));
  painter.drawPolyline(outline.mid(half));
}

void paintShape(QPainter& painter, const ViewTransform& transform, const Mark& mark) {
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
      painter.drawPolygon(diamond(at, half));
      break;
    case MarkShape::kTriangle:
      painter.drawPolygon(
          QPolygonF({at + QPointF(0.0, -half), at + QPointF(0.87 * half, 0.5 * half),
                     at + QPointF(-0.87 * half, 0.5 * half)}));
      break;
    case MarkShape::kTarget:
      paintTicks(painter, at, 0.35 * half, 1.35 * half);
      painter.drawEllipse(at, half, half);
      break;
    case MarkShape::kStruck:
      painter.drawEllipse(at, half, half);
      painter.drawLine(at + QPointF(-half, half), at + QPointF(half, -half));
      break;
    case MarkShape::kArrow:
      paintArrow(painter, at, transform.toWidget(mark.to));
      break;
    case MarkShape::kSegment:
      painter.drawLine(at, transform.toWidget(mark.to));
      break;
    case MarkShape::kRectangle:
      painter.drawRect(transform.toWidget(mark.area));
      break;
    case MarkShape::kStrip: {
      QPolygonF outline;
      for (const QPointF& pixel : mark.outline) outline << transform.toWidget(pixel);
      paintStrip(painter, outline);
      break;
    }
  }
}

/// Of an annotation a chip in its colour.
void paintLabel(QPainter& painter, const QPointF& at, const Mark& mark, const QColor& color) {
  if (mark.label.isEmpty()) return;
  const bool chip = mark.line && mark.cased;
  if (mark.cased) {
    const QFontMetricsF metrics(painter.font());
    const QRectF ground(at.x() - 3.0, at.y() - metrics.ascent() - 1.0,
                        metrics.horizontalAdvance(mark.label) + 6.0, metrics.height() + 2.0);
    painter.setPen(Qt::NoPen);
    painter.setBrush(chip ? color : kLabelGround);
    painter.drawRoundedRect(ground, 2.0, 2.0);
    painter.setBrush(Qt::NoBrush);
  }
  painter.setPen(chip && color.lightnessF() > 0.7 ? Qt::black : chip ? Qt::white : color);
  painter.drawText(at, mark.label);
}

}  // namespace

double distanceToSegment(const QPointF& from, const QPointF& to, const QPointF& place) {
  const QPointF way = to - from;
  const double squared = QPointF::dotProduct(way, way);
  const double share =
      squared > 0.0 ? std::clamp(QPointF::dotProduct(place - from, way) / squared, 0.0, 1.0) : 0.0;
  return length(place - (from + way * share));
}

void paintTicks(QPainter& painter, const QPointF& at, double from, double to) {
  for (const QPointF& way :
       {QPointF(1.0, 0.0), QPointF(-1.0, 0.0), QPointF(0.0, 1.0), QPointF(0.0, -1.0)})
    painter.drawLine(at + from * way, at + to * way);
}

QPolygonF diamond(const QPointF& at, double half) {
  return {{at + QPointF(0.0, -half), at + QPointF(half, 0.0), at + QPointF(0.0, half),
           at + QPointF(-half, 0.0)}};
}

void paintMark(QPainter& painter, const ViewTransform& transform, const Mark& mark,
               const QColor& layer_color) {
  const QColor color = mark.color.isValid() ? mark.color : layer_color;
  painter.setBrush(Qt::NoBrush);
  QPen pen(color, mark.width);
  if (mark.line) {
    LineToken line = *mark.line;
    line.color = color.rgb();
    painter.setPen(haloPen(line));
    paintShape(painter, transform, mark);
    pen = linePen(line);
  } else {
    if (mark.cased) {
      painter.setPen(QPen(kCasing, mark.width + 2.0));
      paintShape(painter, transform, mark);
    }
    if (mark.dashed) pen.setDashPattern({3.0, 3.0});
  }
  painter.setPen(pen);
  paintShape(painter, transform, mark);
  painter.setBrush(Qt::NoBrush);
  const double half = 0.5 * mark.size_px;
  paintLabel(painter, transform.toWidget(mark.at) + QPointF(half + 3.0, -half), mark, color);
}

double distanceTo(const ViewTransform& transform, const Mark& mark, const QPointF& widget) {
  const QPointF at = transform.toWidget(mark.at);
  if (mark.shape == MarkShape::kArrow || mark.shape == MarkShape::kSegment)
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

bool reaches(const ViewTransform& transform, const Mark& mark, const QRectF& area) {
  constexpr double kLabelHeight = 40.0;
  const double margin = mark.size_px + mark.width + kLabelHeight;
  double top = transform.toWidget(mark.at).y();
  double bottom = top;
  const auto extend = [&](const QPointF& pixel) {
    const double y = transform.toWidget(pixel).y();
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  };
  if (mark.shape == MarkShape::kArrow || mark.shape == MarkShape::kSegment) extend(mark.to);
  if (mark.shape == MarkShape::kRectangle) {
    top = bottom = transform.toWidget(mark.area.topLeft()).y();
    extend(mark.area.bottomRight());
  }
  if (mark.shape == MarkShape::kStrip && !mark.outline.isEmpty()) {
    top = bottom = transform.toWidget(mark.outline.front()).y();
    for (const QPointF& pixel : mark.outline) extend(pixel);
  }
  return bottom + margin >= area.top() && top - margin <= area.bottom();
}

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

QSizeF noteSize(const QPainter& painter, const QString& text) {
  const QFontMetricsF metrics(painter.font());
  return {metrics.horizontalAdvance(text) + 16.0, metrics.height() + 8.0};
}

void paintNote(QPainter& painter, const QPointF& top_left, const QString& text) {
  const QRectF box(top_left, noteSize(painter, text));
  painter.setPen(QColor(kDarkTheme.overlay_line));
  painter.setBrush(QColor(kDarkTheme.overlay));
  painter.drawRoundedRect(box, kRadius, kRadius);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QColor(kOverlayText));
  painter.drawText(box, Qt::AlignCenter, text);
}

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
