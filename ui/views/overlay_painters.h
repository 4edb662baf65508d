// SPDX-License-Identifier: Apache-2.0
// Signs drawn over the image.
#pragma once

#include <vector>

#include <QColor>
#include <QPainter>
#include <QPointF>
#include <QSizeF>
#include <QString>

#include "ui/views/layer.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

inline constexpr QColor kLoupeCrossColor(255, 255, 255, 210);

/// The cross hairs of a loupe of this size, open about its middle, readable on dark and light.
/// Leaves no brush behind.
void paintLoupeCross(QPainter& painter, const QSizeF& loupe);

/// Draws four short lines that leave the position itself free.
void paintTicks(QPainter& painter, const QPointF& at, double from, double to);
QPolygonF diamond(const QPointF& at, double half);
double distanceToSegment(const QPointF& from, const QPointF& to, const QPointF& place);

/// Draws a mark with lines of constant width at any zoom.
void paintMark(QPainter& painter, const ViewTransform& transform, const Mark& mark,
               const QColor& layer_color);

/// Whether the mark may be seen between the top and the bottom of an area of the widget.
bool reaches(const ViewTransform& transform, const Mark& mark, const QRectF& area);

/// Distance on the widget from a position to the drawn mark.
double distanceTo(const ViewTransform& transform, const Mark& mark, const QPointF& widget);

/// The size of a note over the image, and the note: a dark rounded box with one line of text.
QSizeF noteSize(const QPainter& painter, const QString& text);
void paintNote(QPainter& painter, const QPointF& top_left, const QString& text);

/// Preview of a tool's effect during a gesture, drawn over the image: a brush's track, or a
/// polygon's outline.
struct ToolPreview {
  std::vector<QPointF> points;  ///< px
  double radius_px = 0.0;       ///< of a brush; 0: an outline
  bool filled = false;          ///< the area inside the outline too
  QColor color;                 ///< with the opacity that it is drawn with
};

void paintPreview(QPainter& painter, const ViewTransform& transform, const ToolPreview& preview);

}  // namespace boresight::ui
