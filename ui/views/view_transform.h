// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <QMouseEvent>
#include <QPointF>
#include <QRectF>
#include <QSizeF>
#include <QWidget>

namespace boresight::ui {

/// Position of the pointer on a widget, in its coordinates: the centre of the screen pixel at the
/// pointer's tip. Windowing systems report that pixel's corner. Qt 5 rounds it to whole coordinates
/// of the widget, which on scaled displays are more than a screen pixel apart; the position in the
/// window keeps the fraction.
inline QPointF pointerPlace(const QMouseEvent& event, const QWidget& widget) {
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  const QPointF in_window = event.windowPos() - widget.mapTo(widget.window(), QPoint());
  // An event that was sent on from elsewhere keeps the position in the window it came from.
  const bool same_window = (in_window - event.localPos()).manhattanLength() <= 1.0;
  const QPointF corner = same_window ? in_window : event.localPos();
#else
  const QPointF corner = event.position();
#endif
  const double half = 0.5 / widget.devicePixelRatioF();
  return corner + QPointF(half, half);
}

/// A pixel as a Qt point, and back.
inline QPointF pointOf(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y()}; }
inline Eigen::Vector2d vectorOf(const QPointF& point) { return {point.x(), point.y()}; }

inline double distance_px(const QPointF& a, const QPointF& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

/// Direction of an arrow key on the screen; zero for other keys.
inline QPointF arrowOf(int key) {
  return QPointF((key == Qt::Key_Right) - (key == Qt::Key_Left),
                 (key == Qt::Key_Down) - (key == Qt::Key_Up));
}

/// Between image pixels (the centre of the top-left one is (0, 0)) and the widget's coordinates:
/// widget = (pixel + 0.5) * scale + offset, so that a pixel covers a square of side `scale`.
class ViewTransform {
 public:
  static constexpr double kMinScale = 1.0 / 64.0;
  static constexpr double kMaxScale = 128.0;

  double scale() const { return scale_; }
  QPointF toWidget(const QPointF& pixel) const;
  template <class Pixel>
  QPointF toWidget(const Eigen::MatrixBase<Pixel>& pixel) const {
    return toWidget(pointOf(pixel));
  }
  QPointF toPixel(const QPointF& widget) const;
  /// Corners of pixels on the widget: the whole image is toWidget({-0.5, -0.5, width, height}).
  QRectF toWidget(const QRectF& pixels) const;

  /// Shows the whole image, centred.
  void fit(const QSizeF& image, const QSizeF& widget);
  /// Sets the scale about a fixed point of the widget.
  void zoomAt(const QPointF& widget, double scale);
  void pan(const QPointF& widget_delta) { offset_ += widget_delta; }
  /// Moves a pixel to the middle of the widget.
  void centreOn(const QPointF& pixel, const QSizeF& widget);

  bool operator==(const ViewTransform&) const = default;

 private:
  double scale_ = 1.0;
  QPointF offset_;
};

}  // namespace boresight::ui
