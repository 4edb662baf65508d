// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QMouseEvent>
#include <QPointF>
#include <QWidget>

namespace boresight::ui {

/// Where the pointer is on a widget, in its coordinates: the centre of the screen pixel that the
/// pointer's tip is on. Windowing systems tell that pixel's corner, and QMouseEvent::pos() rounds
/// it to whole coordinates, which where the display is scaled are more than a screen pixel apart.
inline QPointF pointerPlace(const QMouseEvent& event, const QWidget& widget) {
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  const QPointF corner = event.localPos();
#else
  const QPointF corner = event.position();
#endif
  const double half = 0.5 / widget.devicePixelRatioF();
  return corner + QPointF(half, half);
}

}  // namespace boresight::ui
