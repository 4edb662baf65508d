// SPDX-License-Identifier: Apache-2.0
#include "ui/views/overlay_painters.h"

#include <algorithm>
#include <array>
#include <limits>

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
    paintTicks(painter, middle, kGap, middle.x());
  }
}

namespace {

const QColor kCasing(0, 0, 0, 170);
const QColor kLabelGround(0, 0, 0, 130);
constexpr double kStripFill = 0.45;

void paintArrow(QPainter& painter, const QPointF& from, const QPointF& to) {
  painter.drawLine(from, to);
  const QPointF way = to - from;
  const double long_px = distance_px(from, to);
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

template <class Pixels>
QPolygonF onWidget(const ViewTransform& transform, const Pixels& pixels) {
  QPolygonF polygon;
  for (const QPointF& pixel : pixels) polygon << transform.toWidget(pixel);
  return polygon;
}

/// The lines or the centre of a mark on the widget.
QPolygonF markLines(const ViewTransform& transform, const Mark& mark) {
  if (mark.shape == MarkShape::kArrow || mark.shape == MarkShape::kSegment)
    return onWidget(transform, std::array{mark.at, mark.to});
  if (mark.shape == MarkShape::kRectangle) return transform.toWidget(mark.area);
  if (mark.shape == MarkShape::kStrip) return onWidget(transform, mark.outline);
  return onWidget(transform, std::array{mark.at});
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
    case MarkShape::kStrip:
      paintStrip(painter, onWidget(transform, mark.outline));
      break;
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
  return distance_px(place, from + way * share);
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
  const QPolygonF lines = markLines(transform, mark);
  if (lines.size() == 1) return std::max(0.0, distance_px(widget, lines[0]) - 0.5 * mark.size_px);
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 1; i < lines.size(); ++i)
    nearest = std::min(nearest, distanceToSegment(lines[i - 1], lines[i], widget));
  return nearest;
}

bool reaches(const ViewTransform& transform, const Mark& mark, const QRectF& area) {
  constexpr double kLabelHeight = 40.0;
  const double margin = mark.size_px + mark.width + kLabelHeight;
  const QRectF lines = markLines(transform, mark).boundingRect();
  return lines.bottom() + margin >= area.top() && lines.top() - margin <= area.bottom();
}

namespace {

constexpr double kCorner = 3.5;

void paintTrack(QPainter& painter, const QPolygonF& track, double width, const QColor& color) {
  painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  if (track.size() == 1)
    painter.drawPoint(track.front());
  else
    painter.drawPolyline(track);
}

/// Dark under bright: seen on any image.
std::array<QPen, 2> previewPens(QColor color) {
  color.setAlphaF(1.0);
  return {QPen(QColor(0, 0, 0, 160), 3.0), QPen(color, 1.5)};
}

void paintOutline(QPainter& painter, const QPolygonF& outline, const QColor& color, bool filled) {
  for (const QPen& pen : previewPens(color)) {
    painter.setPen(pen);
    painter.setBrush(color);
    if (filled)
      painter.drawPolygon(outline);
    else
      painter.drawPolyline(outline);
  }
  QColor opaque = color;
  opaque.setAlphaF(1.0);
  painter.setBrush(opaque);
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
  const QPolygonF points = onWidget(transform, preview.points);
  if (preview.radius_px > 0.0) {
    const double radius = preview.radius_px * transform.scale();
    paintTrack(painter, points, 2.0 * radius, preview.color);
    painter.setBrush(Qt::NoBrush);
    for (const QPen& pen : previewPens(preview.color)) {
      painter.setPen(pen);
      painter.drawEllipse(points.back(), radius, radius);
    }
  } else {
    paintOutline(painter, points, preview.color, preview.filled);
  }
}

}  // namespace boresight::ui
