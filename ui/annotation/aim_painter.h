// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QPainter>

#include "ui/annotation/mark_aim.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// Draws where a click would go and what it snaps to: the place, the way from the pointer, the
/// ellipse or the edge that was found. Seen on any image: bright over a dark rim.
void paintAim(QPainter& painter, const ViewTransform& transform, const MarkAim& aim,
              const QPointF& pointer);

/// A sentence on a dark ground with room at its right; where it was drawn.
QRectF paintBox(QPainter& painter, const QPointF& top_left, const QString& text, double room = 0.0);

/// A sentence beside a place of the widget, on a dark ground, kept inside `area` and clear of
/// `taken`.
void paintNote(QPainter& painter, const QRectF& area, const QRectF& taken, const QPointF& beside,
               const QString& text);

}  // namespace boresight::ui
