// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pixel_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <QPainter>

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

struct Color {
  double red, green, blue;
};

/// Nine of viridis' 256 colours, evenly spaced; straight lines in between.
constexpr std::array<Color, 9> kStops = {{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

}  // namespace

QRgb heatColor(double value) {
  const double place = std::clamp(value, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double share = place - static_cast<double>(below);
  const Color& a = kStops[below];
  const Color& b = kStops[below + 1];
  const auto mixed = [share](double from, double to) {
    return static_cast<int>(std::lround(from + share * (to - from)));
  };
  return qRgb(mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue));
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
