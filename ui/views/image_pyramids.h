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

/// A gray image for drawing at any zoom: each coarser picture is the mean over 2x2 pixels.
class GrayPyramid {
 public:
  GrayPyramid() = default;
  explicit GrayPyramid(QImage gray);  ///< Format_Grayscale8

  bool isNull() const { return pictures_.empty(); }
  const QImage& full() const { return pictures_.front(); }
  QSize size() const { return isNull() ? QSize() : full().size(); }
  /// The picture whose pixels cover 2^step pixels of the image, as large a step as
  /// `image_per_pixel` allows; coarser ones are made when they are asked for.
  const QImage& at(double image_per_pixel, int& step) const;

 private:
  mutable std::vector<QImage> pictures_;
};

}  // namespace boresight::ui
