// SPDX-License-Identifier: Apache-2.0
// The mouse on a widget, where QTest has no places between coordinates and moves without a button.
#pragma once

#include <cmath>
#include <initializer_list>

#include <QtWidgets>

namespace boresight::test {

/// What the windowing system reports when the pointer's tip is on the screen pixel of a place.
inline QPointF cornerOfScreenPixel(const QWidget& widget, const QPointF& at) {
  const double ratio = widget.devicePixelRatioF();
  return QPointF(std::floor(at.x() * ratio), std::floor(at.y() * ratio)) / ratio;
}

/// `button` is the one that is pressed, released, or held while the pointer moves. As Qt 5 does it,
/// only the position in the window keeps fractions of a coordinate.
inline void sendMouse(QWidget& widget, QEvent::Type type, const QPointF& at,
                      Qt::MouseButton button = Qt::LeftButton,
                      Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  const QPointF corner = widget.mapTo(widget.window(), QPoint());
  const QPointF in_window = corner + at;
  QMouseEvent event(type, QPointF(in_window.toPoint()) - corner, in_window,
                    QPointF(widget.mapToGlobal(QPoint())) + at,
                    type == QEvent::MouseMove ? Qt::NoButton : button,
                    type == QEvent::MouseButtonRelease ? Qt::NoButton : button, modifiers);
  QCoreApplication::sendEvent(&widget, &event);
}

inline void moveMouse(QWidget& widget, const QPointF& at,
                      Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  sendMouse(widget, QEvent::MouseMove, at, Qt::NoButton, modifiers);
}

/// Presses at the first place and releases at the last.
inline void dragMouse(QWidget& widget, std::initializer_list<QPointF> places,
                      Qt::MouseButton button = Qt::LeftButton,
                      Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  sendMouse(widget, QEvent::MouseButtonPress, *places.begin(), button, modifiers);
  for (const QPointF* at = places.begin() + 1; at != places.end(); ++at)
    sendMouse(widget, QEvent::MouseMove, *at, button, modifiers);
  sendMouse(widget, QEvent::MouseButtonRelease, *(places.end() - 1), button, modifiers);
}

inline void turnWheel(QWidget& widget, const QPointF& at, int notches,
                      Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QWheelEvent event(at, widget.mapToGlobal(at.toPoint()), {}, {0, 120 * notches}, Qt::NoButton,
                    modifiers, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&widget, &event);
}

}  // namespace boresight::test
