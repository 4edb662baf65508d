// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pixel_picture.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

namespace boresight::ui {
namespace {

/// From here on squares of unequal size would be seen as such; below, size counts for more.
constexpr double kWholeScale = 3.0;

}  // namespace

QRectF pixelPlace(const QSize& picture, const QRectF& room, double device_pixel_ratio) {
  const double across = room.width() * device_pixel_ratio / std::max(1, picture.width());
  const double down = room.height() * device_pixel_ratio / std::max(1, picture.height());
  const double fits = std::min(across, down);
  const double scale = (fits >= kWholeScale ? std::floor(fits) : fits) / device_pixel_ratio;
  QRectF place(QPointF(), QSizeF(picture) * scale);
  place.moveCenter(room.center());
  // On whole device pixels, or the squares blur.
  const auto whole = [&](double value) {
    return std::round(value * device_pixel_ratio) / device_pixel_ratio;
  };
  place.moveTopLeft({whole(place.left()), whole(place.top())});
  return place;
}

PixelPicture::PixelPicture(const QString& title, QWidget* parent) : QWidget(parent), title_(title) {
  setAccessibleName(title);
}

void PixelPicture::setPicture(const QImage& picture) {
  picture_ = picture;
  update();
}

void PixelPicture::setNote(const QString& note) {
  note_ = note;
  legend_.clear();
  update();
}

void PixelPicture::setLegend(const QVector<QPair<QRgb, QString>>& legend) {
  legend_ = legend;
  update();
}

void PixelPicture::paintLegend(QPainter& painter, const QRect& place) const {
  const int sample = place.height() / 2;
  int x = place.left();
  for (const auto& [color, text] : legend_) {
    painter.fillRect(x, place.center().y() - sample / 2, sample, sample, QColor(color));
    painter.drawRect(x, place.center().y() - sample / 2, sample, sample);
    x += sample + 4;
    painter.drawText(QRect(x, place.top(), place.right() - x, place.height()),
                     Qt::AlignLeft | Qt::AlignVCenter, text);
    x += fontMetrics().horizontalAdvance(text) + 8;
  }
}

void PixelPicture::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const int line = fontMetrics().height();
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(QRect(0, 0, width(), line), Qt::AlignCenter, title_);
  const QRect note_place(0, height() - line, width(), line);
  if (picture_.isNull()) {
    painter.drawText(rect().adjusted(4, line, -4, 0), Qt::AlignCenter | Qt::TextWordWrap, note_);
    return;
  }
  if (legend_.isEmpty()) {
    painter.drawText(note_place, Qt::AlignCenter,
                     fontMetrics().elidedText(note_, Qt::ElideRight, width()));
  } else {
    paintLegend(painter, note_place);
  }
  const QRectF room(0, line + 2, width(), height() - 2 * line - 4);
  painter.drawImage(pixelPlace(picture_.size(), room, devicePixelRatioF()), picture_);
}

}  // namespace boresight::ui
