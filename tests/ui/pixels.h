// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <QImage>

namespace boresight::test {

/// Number of pixels (x, y) of a picture of this size for which a condition holds.
template <class Holds>
int countPixels(const QSize& size, const Holds& holds) {
  int count = 0;
  for (int y = 0; y < size.height(); ++y)
    for (int x = 0; x < size.width(); ++x) count += holds(x, y) ? 1 : 0;
  return count;
}

/// Centre of the pixels of a picture, each with a weight by its place and its colour.
template <class Weight>
QPointF centroid(const QImage& picture, double least_weight, const Weight& weight_of) {
  QPointF sum;
  double weight = 0.0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const QPointF at(x + 0.5, y + 0.5);
      const double own = weight_of(at, picture.pixel(x, y));
      sum += own * at;
      weight += own;
    }
  EXPECT_GT(weight, least_weight);
  return sum / weight;
}

}  // namespace boresight::test
