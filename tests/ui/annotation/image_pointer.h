// SPDX-License-Identifier: Apache-2.0
// The pointer on an image view: real events at image pixels, at any zoom and screen scaling.
#pragma once

#include <cmath>

#include <QtWidgets>

#include <Eigen/Core>

#include "ui/views/image_view.h"

namespace boresight::ui {

class ImagePointer {
 protected:
  ~ImagePointer() = default;

  virtual ImageView& view() = 0;
  /// Length of a screen pixel in image pixels.
  double screenPixel_px() {
    return 1.0 / (view().transform().scale() * view().devicePixelRatioF());
  }

  /// So many coordinates of the widget to an image pixel, with this pixel in the middle.
  void zoom(const Eigen::Vector2d& pixel, double scale) {
    ViewTransform transform = view().transform();
    transform.zoomAt(QPointF(0.0, 0.0), scale);
    transform.centreOn(QPointF(pixel.x(), pixel.y()), view().size());
    view().setTransform(transform);
  }

  void send(QEvent::Type type, const Eigen::Vector2d& pixel,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier,
            Qt::MouseButton button = Qt::LeftButton, bool held = false) {
    const QPointF at = cornerOfScreenPixel(pixel);
    const bool moves = type == QEvent::MouseMove;
    QMouseEvent event(type, at, QPointF(view().mapToGlobal(QPoint(0, 0))) + at,
                      moves ? Qt::NoButton : button,
                      type == QEvent::MouseButtonPress || held ? button : Qt::NoButton, modifiers);
    QCoreApplication::sendEvent(&view(), &event);
  }
  void moveTo(const Eigen::Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    send(QEvent::MouseMove, pixel, modifiers);
  }
  void click(const Eigen::Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier,
             Qt::MouseButton button = Qt::LeftButton) {
    moveTo(pixel, modifiers);
    send(QEvent::MouseButtonPress, pixel, modifiers, button);
    send(QEvent::MouseButtonRelease, pixel, modifiers, button);
  }
  void drag(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    moveTo(from);
    send(QEvent::MouseButtonPress, from);
    send(QEvent::MouseMove, 0.5 * (from + to), Qt::NoModifier, Qt::LeftButton, true);
    send(QEvent::MouseMove, to, Qt::NoModifier, Qt::LeftButton, true);
    send(QEvent::MouseButtonRelease, to);
  }

 private:
  /// What the windowing system tells when the pointer's tip is on the screen pixel of a place.
  QPointF cornerOfScreenPixel(const Eigen::Vector2d& pixel) {
    const double ratio = view().devicePixelRatioF();
    const QPointF at = view().transform().toWidget(QPointF(pixel.x(), pixel.y()));
    return QPointF(std::floor(at.x() * ratio), std::floor(at.y() * ratio)) / ratio;
  }
};

}  // namespace boresight::ui
