// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_pyramids.h"

#include <algorithm>
#include <cstdint>
#include <utility>

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

/// Every 2x2 pixels combined into one; at odd borders the last ones count twice.
template <class Pixel, class Combine>
QImage halved(const QImage& fine, Combine&& combine) {
  QImage coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2, fine.format());
  for (int y = 0; y < coarse.height(); ++y) {
    const int below = std::min(2 * y + 1, fine.height() - 1);
    const auto* upper = reinterpret_cast<const Pixel*>(fine.constScanLine(2 * y));
    const auto* lower = reinterpret_cast<const Pixel*>(fine.constScanLine(below));
    auto* line = reinterpret_cast<Pixel*>(coarse.scanLine(y));
    for (int x = 0; x < coarse.width(); ++x) {
      const int right = std::min(2 * x + 1, fine.width() - 1);
      line[x] = combine(upper[2 * x], upper[right], lower[2 * x], lower[right]);
    }
  }
  return coarse;
}

/// The coarsest picture whose pixels cover at most so many of the finest one's, made when it is not
/// there yet.
template <class Halve>
const QImage& pictureFor(double fine_per_pixel, std::vector<QImage>& pictures, int& step,
                         Halve&& halve) {
  step = 0;
  while ((2 << step) <= fine_per_pixel && step < 12) {
    ++step;
    if (static_cast<std::size_t>(step) == pictures.size())
      pictures.push_back(halve(pictures.back()));
  }
  return pictures[static_cast<std::size_t>(step)];
}

}  // namespace

BitPixmaps::BitPixmaps(const BitImage& bits, const QColor& color) {
  pictures_.push_back(pictureOf(bits, qPremultiply(color.rgba())));
}

/// Set pixels all have the same colour: OR keeps it.
const QImage& BitPixmaps::at(double bits_per_pixel, int& step) {
  return pictureFor(bits_per_pixel, pictures_, step, [](const QImage& fine) {
    return halved<QRgb>(fine, [](QRgb a, QRgb b, QRgb c, QRgb d) { return a | b | c | d; });
  });
}

GrayPyramid::GrayPyramid(QImage gray) {
  if (!gray.isNull()) pictures_.push_back(std::move(gray));
}

const QImage& GrayPyramid::at(double image_per_pixel, int& step) const {
  return pictureFor(image_per_pixel, pictures_, step, [](const QImage& fine) {
    return halved<uchar>(fine, [](int a, int b, int c, int d) {
      return static_cast<uchar>((a + b + c + d + 2) / 4);
    });
  });
}

}  // namespace boresight::ui
