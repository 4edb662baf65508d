// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/loupe.h"

#include "tests/ui/annotation/annotation_fixture.h"
#include "tests/ui/pixels.h"

namespace boresight::ui {
namespace {

/// Neighbours differ clearly; 0 and 255 are both near every place.
int grayAt(int x, int y) { return ((x * 37 + y * 91) % 16) * 17; }

std::shared_ptr<const sessions::ImageSamples> pattern(int side) {
  auto samples = std::make_shared<sessions::ImageSamples>();
  samples->width = samples->height = side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      samples->values.push_back(static_cast<std::uint16_t>(grayAt(x, y)));
  return samples;
}

/// The image pixel under the middle of a screen pixel, reckoned from the middle of the picture.
int pixelUnder(double focus, int screen_pixel, int side, double magnification) {
  return static_cast<int>(
      std::floor(focus + (screen_pixel + 0.5 - 0.5 * side) / magnification + 0.5));
}

struct LoupeCase {
  double ratio;
  double magnification;
  int side;  ///< in coordinates
};

TEST(LoupePicture, EveryScreenPixelHasTheGrayOfTheImagePixelUnderItsMiddle) {
  for (const auto& [ratio, magnification, side] :
       {LoupeCase{1.0, 8.0, 200}, LoupeCase{1.5, 8.0, 168}, LoupeCase{2.0, 8.0, 168},
        LoupeCase{1.0, 11.3, 201}, LoupeCase{1.5, 22.6, 168}, LoupeCase{2.0, 64.0, 320}}) {
    SCOPED_TRACE(testing::Message() << ratio << " " << magnification);
    const auto samples = pattern(100);
    const int screen = static_cast<int>(std::lround(side * ratio));
    for (const QPointF& focus :
         {QPointF(50.013, 40.021), QPointF(33.37, 61.92), QPointF(1.2, 98.7)}) {
      ViewTransform transform;
      transform.zoomAt(QPointF(0.0, 0.0), magnification / ratio);
      transform.centreOn(focus, QSizeF(side, side));
      const QImage picture = loupePicture(*samples, transform, QSize(screen, screen), ratio);
      ASSERT_EQ(picture.size(), QSize(screen, screen));
      const auto wrong = [&](int x, int y) {
        const int u = pixelUnder(focus.x(), x, screen, magnification);
        const int v = pixelUnder(focus.y(), y, screen, magnification);
        const bool inside = u >= 0 && v >= 0 && u < 100 && v < 100;
        const int drawn = qRed(picture.pixel(x, y));
        // The stretch of a pattern from 0 to 255 changes nothing.
        return inside ? drawn != grayAt(u, v) : drawn > 40;
      };
      EXPECT_EQ(test::countPixels(picture.size(), wrong), 0) << focus.x() << ", " << focus.y();
    }
  }
}

TEST(LoupePicture, FaintContrastIsStretchedToWhatIsShown) {
  sessions::ImageSamples samples;
  samples.width = samples.height = 60;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x)
      samples.values.push_back(static_cast<std::uint16_t>(x < 30 ? 100 : x < 50 ? 104 : 255));
  ViewTransform transform;
  transform.zoomAt(QPointF(0.0, 0.0), 8.0);
  transform.centreOn(QPointF(30.0, 30.0), QSizeF(160.0, 160.0));  // from 20 to 40
  const QImage picture = loupePicture(samples, transform, QSize(160, 160), 1.0);
  EXPECT_LT(qRed(picture.pixel(20, 80)), 10);
  EXPECT_GT(qRed(picture.pixel(140, 80)), 245);
}

class LoupeTest : public ImageAnnotationTest {
 protected:
  void SetUp() override {
    ImageAnnotationTest::SetUp();
    controller_.setMode(PlaceMode::kPoint);
    tool().setSnaps(false);
  }
  Loupe& loupe() { return annotation_.loupe(); }
};

TEST_F(LoupeTest, FollowsThePointerInTheCornerThatItIsNotIn_UntilItIsOffOrThePointerLeaves) {
  panel_.view().fit();
  const Vector2d middle(512.3, 500.6);
  moveTo(middle);
  ASSERT_TRUE(loupe().isVisible());
  EXPECT_NEAR(loupe().place()->x(), middle.x(), screenPixel_px());
  EXPECT_NEAR(loupe().place()->y(), middle.y(), screenPixel_px());
  // What is at a place of the loupe is at the place of the view that the pointer is on.
  const QPointF centre(0.5 * loupe().width(), 0.5 * loupe().height());
  EXPECT_NEAR(loupe().transform().toPixel(centre).x(), loupe().place()->x(), 1e-9);
  for (const double x : {1000.0, 20.0, 1000.0}) {
    moveTo({x, 20.0});
    const QPointF at = view().transform().toWidget(QPointF(x, 20.0));
    EXPECT_FALSE(loupe().geometry().contains(at.toPoint())) << x;
  }
  for (const bool on : {false, true}) {
    loupe().setSwitchedOn(on);
    EXPECT_EQ(loupe().isVisible(), on);
  }
  QEvent leave(QEvent::Leave);
  QCoreApplication::sendEvent(&view(), &leave);
  EXPECT_FALSE(loupe().isVisible());
  moveTo(middle);
  ASSERT_TRUE(loupe().isVisible());
  controller_.setMode(PlaceMode::kOff);
  EXPECT_FALSE(loupe().isVisible());
}

TEST_F(LoupeTest, CtrlAndTheWheelMagnifyItWithinBoundsAndTheViewStays) {
  moveTo({500.0, 500.0});
  EXPECT_EQ(loupe().magnification(), 8.0);
  const ViewTransform before = view().transform();
  const auto turned = [&](int notches) {
    test::turnWheel(view(), {100.0, 100.0}, notches, Qt::ControlModifier);
    return loupe().magnification();
  };
  EXPECT_NEAR(turned(2), 16.0, 1e-9);
  EXPECT_EQ(turned(20), 64.0);
  EXPECT_EQ(turned(-40), 4.0);
  EXPECT_EQ(view().transform(), before);
  zoom({500.0, 500.0}, 10.0);
  EXPECT_NEAR(loupe().magnification(), 20.0 * view().devicePixelRatioF(), 1e-9)
      << "never less than the view itself";
}

/// Light on the loupe where the annotation is, at its place to half a screen pixel.
TEST_F(LoupeTest, DrawsAnnotationsAtTheirPlace) {
  paintImage([](int, int) { return 0.0; });
  const Vector2d place(500.37, 480.81);
  zoom(place, 3.7);
  click(place);
  controller_.select({});
  const Vector2d annotated = *annotations().points[0].pixel;
  moveTo(place + Vector2d(4.0, 3.0));
  const QImage picture = loupe().grab().toImage();
  const double ratio = picture.devicePixelRatio();
  const QPointF expected =
      ratio * loupe().transform().toWidget(QPointF(annotated.x(), annotated.y()));
  const QPointF found =
      test::centroid(picture, 1000.0, [&](const QPointF& at, QRgb color) -> double {
        const QPointF off = at - expected;
        if (std::hypot(off.x(), off.y()) > 11.0 * ratio) return 0.0;  // its label is beyond
        return std::max(0, qRed(color) - qBlue(color) - 30);
      });
  EXPECT_NEAR(found.x(), expected.x(), 0.5);
  EXPECT_NEAR(found.y(), expected.y(), 0.5);
}

}  // namespace
}  // namespace boresight::ui
