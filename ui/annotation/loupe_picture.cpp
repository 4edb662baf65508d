// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/loupe_picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ui/views/display_stretch.h"

namespace boresight::ui {
namespace {

const QRgb kOutside = qRgb(24, 24, 24);

/// The image pixel under the centre of each of `count` screen pixels.
std::vector<int> pixelsUnder(const ViewTransform& transform, int count, double ratio, bool rows) {
  std::vector<int> pixels;
  for (int i = 0; i < count; ++i) {
    const double place = (i + 0.5) / ratio;
    const QPointF pixel = transform.toPixel(QPointF(place, place));
    pixels.push_back(static_cast<int>(std::floor((rows ? pixel.y() : pixel.x()) + 0.5)));
  }
  return pixels;
}

}  // namespace

QImage loupePicture(const sessions::ImageSamples& samples, const ViewTransform& transform,
                    const QSize& size, double device_pixel_ratio) {
  QImage picture(size, QImage::Format_RGB32);
  picture.fill(kOutside);
  const auto columns = pixelsUnder(transform, size.width(), device_pixel_ratio, false);
  const auto rows = pixelsUnder(transform, size.height(), device_pixel_ratio, true);
  const QRect shown =
      QRect(QPoint(columns.front(), rows.front()), QPoint(columns.back(), rows.back())) &
      QRect(0, 0, samples.width, samples.height);
  if (!shown.isEmpty()) {
    sessions::ImageSamples piece;
    piece.width = shown.width();
    piece.height = shown.height();
    piece.sample_bits = samples.sample_bits;
    for (int y = shown.top(); y <= shown.bottom(); ++y) {
      const auto row = samples.values.begin() + std::ptrdiff_t{y} * samples.width + shown.left();
      piece.values.insert(piece.values.end(), row, row + shown.width());
    }
    const QImage gray = stretched(piece, automaticLevels(piece));
    for (int y = 0; y < size.height(); ++y) {
      const int row = rows[static_cast<std::size_t>(y)];
      if (row < shown.top() || row > shown.bottom()) continue;
      auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
      const uchar* from = gray.constScanLine(row - shown.top());
      for (int x = 0; x < size.width(); ++x) {
        const int column = columns[static_cast<std::size_t>(x)];
        if (column < shown.left() || column > shown.right()) continue;
        const int value = from[column - shown.left()];
        line[x] = qRgb(value, value, value);
      }
    }
  }
  picture.setDevicePixelRatio(device_pixel_ratio);
  return picture;
}

sessions::ImageSamples samplesOf(const QImage& gray) {
  sessions::ImageSamples samples;
  samples.width = gray.width();
  samples.height = gray.height();
  for (int y = 0; y < gray.height(); ++y)
    samples.values.insert(samples.values.end(), gray.constScanLine(y),
                          gray.constScanLine(y) + gray.width());
  return samples;
}

}  // namespace boresight::ui
