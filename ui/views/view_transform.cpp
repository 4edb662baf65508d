// SPDX-License-Identifier: Apache-2.0
#include "ui/views/view_transform.h"

#include <algorithm>

namespace boresight::ui {

QPointF ViewTransform::toWidget(const QPointF& pixel) const {
  return (pixel + QPointF(0.5, 0.5)) * scale_ + offset_;
}

QPointF ViewTransform::toPixel(const QPointF& widget) const {
  return (widget - offset_) / scale_ - QPointF(0.5, 0.5);
}

QRectF ViewTransform::toWidget(const QRectF& pixels) const {
  return {toWidget(pixels.topLeft()), toWidget(pixels.bottomRight())};
}

void ViewTransform::fit(const QSizeF& image, const QSizeF& widget) {
  if (image.isEmpty() || widget.isEmpty()) return;
  scale_ = std::clamp(std::min(widget.width() / image.width(), widget.height() / image.height()),
                      kMinScale, kMaxScale);
  offset_ = {0.5 * (widget.width() - image.width() * scale_),
             0.5 * (widget.height() - image.height() * scale_)};
}

void ViewTransform::zoomAt(const QPointF& widget, double scale) {
  const QPointF pixel = toPixel(widget);
  scale_ = std::clamp(scale, kMinScale, kMaxScale);
  offset_ += widget - toWidget(pixel);
}

void ViewTransform::centreOn(const QPointF& pixel, const QSizeF& widget) {
  offset_ += QPointF(0.5 * widget.width(), 0.5 * widget.height()) - toWidget(pixel);
}

}  // namespace boresight::ui
