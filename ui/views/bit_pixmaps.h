// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QColor>
#include <QImage>

#include "core/base/image.h"

namespace boresight::ui {

/// A binary image in one colour for drawing at any zoom. Each coarser picture is the OR of 2x2
/// pixels of the one before, so that a line one pixel wide is still there when the image is drawn
/// small. Coarser pictures are made when they are asked for.
class BitPixmaps {
 public:
  BitPixmaps(const BitImage& bits, const QColor& color);

  /// The picture whose pixels cover 2^step pixels of the bits, with step as large as it can be
  /// while one of its pixels covers at most `bits_per_pixel` of theirs; the step comes back.
  const QImage& at(double bits_per_pixel, int& step);

 private:
  std::vector<QImage> pictures_;  ///< by step, premultiplied ARGB
};

}  // namespace boresight::ui
