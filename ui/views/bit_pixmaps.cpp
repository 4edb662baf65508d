// SPDX-License-Identifier: Apache-2.0
#include "ui/views/bit_pixmaps.h"

#include <algorithm>
#include <cstdint>

namespace boresight::ui {
namespace {

QImage pictureOf(const BitImage& bits, QRgb color) {
  QImage picture(bits.width, bits.height, QImage::Format_ARGB32_Premultiplied);
  for (int y = 0; y < bits.height; ++y) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
    for (int x = 0; x < bits.width; ++x) line[x] = bits.get(x, y) ? color : 0U;
  }
  return picture;
}

/// OR of 2x2 pixels; all set ones have the same colour.
QImage halved(const QImage& fine) {
  const int width = (fine.width() + 1) / 2;
  const int height = (fine.height() + 1) / 2;
  QImage coarse(width, height, QImage::Format_ARGB32_Premultiplied);
  for (int y = 0; y < height; ++y) {
    auto* line = reinterpret_cast<QRgb*>(coarse.scanLine(y));
    const int below = std::min(2 * y + 1, fine.height() - 1);
    const auto* upper = reinterpret_cast<const QRgb*>(fine.constScanLine(2 * y));
    const auto* lower = reinterpret_cast<const QRgb*>(fine.constScanLine(below));
    for (int x = 0; x < width; ++x) {
      const int right = std::min(2 * x + 1, fine.width() - 1);
      line[x] = upper[2 * x] | upper[right] | lower[2 * x] | lower[right];
    }
  }
  return coarse;
}

}  // namespace

BitPixmaps::BitPixmaps(const BitImage& bits, const QColor& color) {
  pictures_.push_back(pictureOf(bits, qPremultiply(color.rgba())));
}

const QImage& BitPixmaps::at(double bits_per_pixel, int& step) {
  step = 0;
  while ((2 << step) <= bits_per_pixel && step < 12) {
    ++step;
    if (static_cast<std::size_t>(step) == pictures_.size())
      pictures_.push_back(halved(pictures_.back()));
  }
  return pictures_[static_cast<std::size_t>(step)];
}

}  // namespace boresight::ui
