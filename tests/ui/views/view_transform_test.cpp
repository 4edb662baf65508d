// SPDX-License-Identifier: Apache-2.0
#include "ui/views/view_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace boresight::ui {
namespace {

double distance(const QPointF& a, const QPointF& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

TEST(ViewTransform, PixelsComeBack) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-3000.0, 3000.0);
  for (int i = 0; i < 1000; ++i) {
    ViewTransform transform;
    transform.zoomAt({place(random), place(random)}, std::exp(place(random) / 1000.0));
    transform.pan({place(random), place(random)});
    const QPointF pixel(place(random), place(random));
    EXPECT_LT(distance(transform.toPixel(transform.toWidget(pixel)), pixel), 1e-6);
  }
}

TEST(ViewTransform, FitsTheWholeImageIntoTheMiddle) {
  ViewTransform transform;
  transform.fit({2048.0, 1024.0}, {512.0, 512.0});
  EXPECT_DOUBLE_EQ(transform.scale(), 0.25);
  const QRectF all = transform.toWidget(QRectF(-0.5, -0.5, 2048.0, 1024.0));
  EXPECT_LT(distance(all.topLeft(), {0.0, 128.0}), 1e-9);
  EXPECT_LT(distance(all.bottomRight(), {512.0, 384.0}), 1e-9);
}

TEST(ViewTransform, TheTopLeftPixelIsASquareAroundItsCentre) {
  ViewTransform transform;
  transform.zoomAt({0.0, 0.0}, 10.0);
  EXPECT_LT(distance(transform.toWidget(QPointF(0.0, 0.0)), {5.0, 5.0}), 1e-9);
}

TEST(ViewTransform, ZoomingKeepsThePixelUnderTheCursor) {
  ViewTransform transform;
  transform.fit({2048.0, 2048.0}, {700.0, 500.0});
  const QPointF cursor(123.0, 456.0);
  const QPointF pixel = transform.toPixel(cursor);
  for (const double scale : {0.5, 3.0, 64.0, 1e9, 1e-9}) {
    transform.zoomAt(cursor, scale);
    EXPECT_LT(distance(transform.toPixel(cursor), pixel), 1e-6);
    EXPECT_LE(transform.scale(), ViewTransform::kMaxScale);
    EXPECT_GE(transform.scale(), ViewTransform::kMinScale);
  }
}

TEST(ViewTransform, AnEmptyImageOrWidgetChangesNothing) {
  ViewTransform transform;
  const ViewTransform before = transform;
  transform.fit({0.0, 0.0}, {100.0, 100.0});
  transform.fit({100.0, 100.0}, {0.0, 10.0});
  EXPECT_EQ(transform, before);
}

}  // namespace
}  // namespace boresight::ui
