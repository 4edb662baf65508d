// SPDX-License-Identifier: Apache-2.0
// Lines on the image: of constant width on the screen, above a halo of the same pattern.
#pragma once

#include <QPen>
#include <QRectF>

#include "sessions/trace/edge_lines.h"
#include "ui/style/tokens.h"

class QPainter;

namespace boresight::ui {

class ViewTransform;

QPen linePen(const LineToken& line);
/// The wider pen below it, whose dashes have the same positions.
QPen haloPen(const LineToken& line);

/// Draws edges at any zoom. Only the parts within `seen` (widget) are drawn, with the pattern of
/// the whole line.
void paintLines(QPainter& painter, const ViewTransform& transform, const sessions::EdgeLines& lines,
                const LineToken& line, const QRectF& seen);

/// Draws a line sample for legends, along the middle of a box.
void paintLineSample(QPainter& painter, const QRectF& box, const LineToken& line);

}  // namespace boresight::ui
