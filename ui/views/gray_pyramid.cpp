// SPDX-License-Identifier: Apache-2.0
#include "ui/views/gray_pyramid.h"

#include <algorithm>
#include <utility>

namespace boresight::ui {
namespace {

QImage halved(const QImage& fine) {
  const int width = (fine.width() + 1) / 2;
  const int height = (fine.height() + 1) / 2;
  QImage coarse(width, height, QImage::Format_Grayscale8);
  for (int y = 0; y < height; ++y) {
    uchar* line = coarse.scanLine(y);
    const uchar* upper = fine.constScanLine(2 * y);
    const uchar* lower = fine.constScanLine(std::min(2 * y + 1, fine.height() - 1));
    for (int x = 0; x < width; ++x) {
      const int right = std::min(2 * x + 1, fine.width() - 1);
      const int sum = upper[2 * x] + upper[right] + lower[2 * x] + lower[right];
      line[x] = static_cast<uchar>((sum + 2) / 4);
    }
  }
  return coarse;
}

}  // namespace

GrayPyramid::GrayPyramid(QImage gray) {
  if (!gray.isNull()) pictures_.push_back(std::move(gray));
}

const QImage& GrayPyramid::at(double image_per_pixel, int& step) const {
  step = 0;
  while ((2 << step) <= image_per_pixel && step < 12) {
    ++step;
    if (static_cast<std::size_t>(step) == pictures_.size())
      pictures_.push_back(halved(pictures_.back()));
  }
  return pictures_[static_cast<std::size_t>(step)];
}

}  // namespace boresight::ui
