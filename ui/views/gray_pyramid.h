// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QImage>

namespace boresight::ui {

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
