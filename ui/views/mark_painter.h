// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QPainter>

#include "ui/views/layer.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// Draws a mark with lines of constant width, whatever the zoom.
void paintMark(QPainter& painter, const ViewTransform& transform, const Mark& mark,
               const QColor& layer_color);

/// Distance on the widget from a place to what is drawn of the mark.
double distanceTo(const ViewTransform& transform, const Mark& mark, const QPointF& widget);

}  // namespace boresight::ui
