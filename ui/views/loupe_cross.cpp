// SPDX-License-Identifier: Apache-2.0
#include "ui/views/loupe_cross.h"

#include <QPainter>

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

}  // namespace boresight::ui
