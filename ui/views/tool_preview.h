// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QColor>
#include <QPainter>
#include <QPointF>

#include "ui/views/view_transform.h"

namespace boresight::ui {

/// What a tool is about to do, drawn over the image while a gesture is under way: a brush's track,
/// or a polygon's outline.
struct ToolPreview {
  std::vector<QPointF> points;  ///< px
  double radius_px = 0.0;       ///< of a brush; 0: an outline
  bool filled = false;          ///< the area inside the outline too
  QColor color;                 ///< with the opacity that it is drawn with
};

void paintPreview(QPainter& painter, const ViewTransform& transform, const ToolPreview& preview);

}  // namespace boresight::ui
