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

int PixelPicture::layOutLegend(QPainter* painter, int top) const {
  const int line = fontMetrics().height();
  const int sample = line / 2;
  int x = 0;
  int lines = legend_.isEmpty() ? 0 : 1;
  for (const auto& [color, text] : legend_) {
    const int wide = sample + 4 + fontMetrics().horizontalAdvance(text);
    if (x > 0 && x + wide > width()) {
      x = 0;
      ++lines;
    }
    if (painter) {
      const int y = top + (lines - 1) * line;
      const QRect box(x, y + (line - sample) / 2, sample, sample);
      painter->fillRect(box, QColor(color));
      painter->drawRect(box);
      painter->drawText(QRect(x + sample + 4, y, wide, line), Qt::AlignLeft | Qt::AlignVCenter,
                        text);
    }
    x += wide + 8;
  }
  return lines;
}

void PixelPicture::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const int line = fontMetrics().height();
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(QRect(0, 0, width(), line), Qt::AlignCenter,
                   fontMetrics().elidedText(title_, Qt::ElideRight, width()));
  if (picture_.isNull()) {
    painter.drawText(rect().adjusted(4, line, -4, 0), Qt::AlignCenter | Qt::TextWordWrap, note_);
    return;
  }
  const int below = std::max(1, layOutLegend(nullptr, 0)) * line;
  if (legend_.isEmpty()) {
    painter.drawText(QRect(0, height() - line, width(), line), Qt::AlignCenter,
                     fontMetrics().elidedText(note_, Qt::ElideRight, width()));
  } else {
    layOutLegend(&painter, height() - below);
  }
  const QRectF room(0, line + 2, width(), height() - line - below - 4);
  painter.drawImage(pixelPlace(picture_.size(), room, devicePixelRatioF()), picture_);
}

}  // namespace boresight::ui
