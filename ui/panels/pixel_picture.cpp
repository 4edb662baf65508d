// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pixel_picture.h"

#include <algorithm>
#include <cmath>

#include <QtWidgets>

namespace boresight::ui {
namespace {

bool bitAt(const BitImage& image, const PatchPlace& place, int u, int v) {
  const int x = place.center_x - place.side_px / 2 + u;
  const int y = place.center_y - place.side_px / 2 + v;
  return image.contains(x, y) && image.get(x, y);
}

/// color_of(u, v) for every pixel.
template <class ColorOf>
QImage drawn(int side_px, const ColorOf& color_of) {
  QImage picture(side_px, side_px, QImage::Format_RGB32);
  for (int v = 0; v < side_px; ++v) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(v));
    for (int u = 0; u < side_px; ++u) line[u] = color_of(u, v);
  }
  return picture;
}

}  // namespace

QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place) {
  return drawn(place.side_px, [&](int u, int v) {
    if (bitAt(edges, place, u, v)) return patch_colors::kEdge;
    return bitAt(mask, place, u, v) ? patch_colors::kMask : patch_colors::kGround;
  });
}

QImage seenPicture(const BitImage& test_edges, const PatchPlace& place) {
  return drawn(place.side_px, [&](int u, int v) {
    return bitAt(test_edges, place, u, v) ? patch_colors::kEdge : patch_colors::kGround;
  });
}

QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found) {
  return drawn(rendered.side_px, [&](int u, int v) {
    if (!bitAt(mask, rendered, u, v)) return patch_colors::kGround;
    const bool is_rendered = bitAt(edges, rendered, u, v);
    const bool is_seen = bitAt(test_edges, found, u, v);
    if (is_rendered && is_seen) return patch_colors::kEdge;
    if (is_rendered) return patch_colors::kOnlyRendered;
    return is_seen ? patch_colors::kOnlySeen : patch_colors::kMask;
  });
}

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

QString colorText(QRgb color, const QString& meaning) {
  return QStringLiteral("<span style='background:%1; color:%2'>■</span>&nbsp;%3 ")
      .arg(QColor(patch_colors::kGround).name(), QColor(color).name(), meaning);
}

PixelPicture::PixelPicture(QWidget* parent)
    : QWidget(parent), title_(new QLabel(this)), note_(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(title_);
  column->addStretch(1);
  column->addWidget(note_);
  for (QLabel* label : {title_, note_}) {
    label->setAlignment(Qt::AlignCenter);
    label->setWordWrap(true);
  }
}

void PixelPicture::setTitle(const QString& title) {
  setAccessibleName(title);
  title_->setText(title);
}

void PixelPicture::setPicture(const QImage& picture, const QString& note) {
  picture_ = picture;
  note_->setText(note);
  static_cast<QVBoxLayout*>(layout())->setStretch(1, picture.isNull() ? 0 : 1);
  update();
}

QString PixelPicture::note() const { return note_->text(); }

QRectF PixelPicture::place() const {
  layout()->activate();  // the note may have changed its height
  const double top = title_->geometry().bottom() + 3.0;
  const QRectF room(0.0, top, width() - marginRight(), note_->geometry().top() - 2.0 - top);
  return pixelPlace(picture_.size(), room, devicePixelRatioF());
}

void PixelPicture::paintEvent(QPaintEvent* /*event*/) {
  if (picture_.isNull()) return;
  QPainter painter(this);
  painter.drawImage(place(), picture_);
  paintOver(painter);
}

}  // namespace boresight::ui
