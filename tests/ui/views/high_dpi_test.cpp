// SPDX-License-Identifier: Apache-2.0
// Runs with QT_SCALE_FACTOR=1.5, where a coordinate of the widget is one and a half screen pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <QtTest>

#include "tests/ui/pixels.h"
#include "tests/ui/pointer.h"
#include "tests/ui/views/view_fixture.h"

namespace boresight::ui {
namespace {

constexpr double kRatio = 1.5;
constexpr int kSide = 200;

/// Neighbours within some pixels of each other have different grays.
int grayAt(int x, int y) { return (7 * x + 31 * y) % 251; }

QImage testImage() {
  QImage gray(kSide, kSide, QImage::Format_Grayscale8);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) gray.scanLine(y)[x] = static_cast<uchar>(grayAt(x, y));
  return gray;
}

class HighDpiTest : public ::testing::TestWithParam<double> {
 protected:
  void SetUp() override {
    ASSERT_DOUBLE_EQ(view_.devicePixelRatioF(), kRatio) << "run with QT_SCALE_FACTOR=1.5";
    view_.resize(301, 203);
    view_.setImage(testImage());
    test::hideLayers(view_);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    test::zoomAt(view_, {150.3, 101.9}, GetParam());
    picture_ = view_.grab().toImage();
  }

  /// What the windowing system tells of the pointer on a screen pixel.
  void moveTo(const QPoint& screen_pixel) {
    test::moveMouse(view_, QPointF(screen_pixel) / kRatio);
  }
  void click(const QPoint& screen_pixel) {
    test::dragMouse(view_, {QPointF(screen_pixel) / kRatio});
  }

  ImageView view_;
  QImage picture_;  ///< of the screen, in its pixels
};

/// Counts the image pixels within half a screen pixel of a place whose gray is the one drawn there.
int grayFits(const QPointF& pixel, double half_screen_pixel, int drawn) {
  const auto rounded = [](double v) { return static_cast<int>(std::floor(v + 0.5)); };
  const QPoint first(rounded(pixel.x() - half_screen_pixel),
                     rounded(pixel.y() - half_screen_pixel));
  const QPoint last(rounded(pixel.x() + half_screen_pixel), rounded(pixel.y() + half_screen_pixel));
  const QRect places = QRect(first, last) & QRect(0, 0, kSide, kSide);
  return test::countPixels(
      places.size(), [&](int x, int y) { return grayAt(places.x() + x, places.y() + y) == drawn; });
}

TEST_P(HighDpiTest, ThePointerTellsThePixelThatIsDrawnUnderIt) {
  ASSERT_EQ(picture_.size(), QSize(452, 305));
  // Exactly half is allowed; the rest is for the rounding of doubles.
  const double half = (0.5 + 1e-6) / (view_.transform().scale() * kRatio);
  QSignalSpy moves(&view_, &ImageView::cursorMoved);
  int seen = 0;
  for (int y = 1; y + 1 < picture_.height(); y += 7) {
    for (int x = 1; x + 1 < picture_.width(); x += 5) {
      moveTo({x, y});
      const QPointF pixel = moves.back()[0].toPointF();
      const bool inside =
          pixel.x() > 0.5 && pixel.y() > 0.5 && pixel.x() < kSide - 1.5 && pixel.y() < kSide - 1.5;
      if (!inside) continue;
      ++seen;
      EXPECT_GE(grayFits(pixel, half, qRed(picture_.pixel(x, y))), 1)
          << "screen pixel " << x << ", " << y << " is told as " << pixel.x() << ", " << pixel.y();
    }
  }
  EXPECT_GT(seen, 500);
}

TEST_P(HighDpiTest, ClickToolAndPointer_GiveTheSamePixel) {
  QSignalSpy moves(&view_, &ImageView::cursorMoved);
  QSignalSpy clicks(&view_, &ImageView::clicked);
  QSignalSpy strokes(&view_, &ImageView::toolPressed);
  for (const QPoint at : {QPoint(100, 100), QPoint(201, 92), QPoint(302, 203)}) {
    moveTo(at);
    click(at);
    EXPECT_EQ(clicks.back()[0].toPointF(), moves.back()[0].toPointF());
    view_.setToolActive(true, 3.0);
    click(at);
    view_.setToolActive(false);
    EXPECT_EQ(strokes.back()[0].toPointF(), moves.back()[0].toPointF());
  }
}

/// "Copy pixel" was off by up to a coordinate, with the point of the station.
TEST_P(HighDpiTest, ContextMenu_IsAtThePixelUnderThePointer) {
  QSignalSpy moves(&view_, &ImageView::cursorMoved);
  QSignalSpy menus(&view_, &ImageView::contextMenuRequested);
  for (const QPoint at : {QPoint(100, 100), QPoint(202, 91)}) {
    const QPointF place = QPointF(at) / kRatio;
    moveTo(at);
    test::sendMouse(view_, QEvent::MouseButtonPress, place, Qt::RightButton);
    QContextMenuEvent event(QContextMenuEvent::Mouse, place.toPoint(),
                            view_.mapToGlobal(place.toPoint()));
    QCoreApplication::sendEvent(&view_, &event);
    EXPECT_EQ(menus.back()[0].toPointF(), moves.back()[0].toPointF());
    test::sendMouse(view_, QEvent::MouseButtonRelease, place, Qt::RightButton);
  }
}

TEST_P(HighDpiTest, AMarkIsDrawnWhereItsPixelIs) {
  Layer layer;
  layer.id = LayerId::kPoints;
  layer.style = {true, QColor(255, 0, 0), 1.0};
  Mark mark;
  mark.shape = MarkShape::kCircle;
  mark.at = view_.transform().toPixel(QPointF(150.25, 101.5));
  mark.item = 5;
  layer.marks = {mark};
  view_.setLayer(layer);
  picture_ = view_.grab().toImage();
  const QPointF centre = test::centroid(picture_, 0.0, [](const QPointF&, QRgb color) {
    return std::max(0, qRed(color) - qBlue(color));
  });
  const QPointF off = centre - kRatio * view_.transform().toWidget(mark.at);
  EXPECT_LT(std::abs(off.x()), 0.5);
  EXPECT_LT(std::abs(off.y()), 0.5);
  const auto pick = view_.pickAt(centre / kRatio);
  ASSERT_TRUE(pick.has_value());
  EXPECT_EQ(pick->item, 5);
}

// From one image pixel per screen pixel up to where the pixel grid begins to cover the pixels.
INSTANTIATE_TEST_SUITE_P(Zooms, HighDpiTest, ::testing::Values(1.0 / kRatio, 1.0, 2.37, 5.0, 7.9));

}  // namespace
}  // namespace boresight::ui
