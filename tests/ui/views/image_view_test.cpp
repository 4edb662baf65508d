// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <QWheelEvent>
#include <QtTest>

namespace boresight::ui {
namespace {

constexpr int kSide = 64;

QImage grayImage() {
  QImage gray(kSide, kSide, QImage::Format_Grayscale8);
  gray.fill(40);
  return gray;
}

/// One bit set in a map of 64 x 64, at a level.
struct OneBit {
  std::shared_ptr<std::vector<std::uint64_t>> words =
      std::make_shared<std::vector<std::uint64_t>>(static_cast<std::size_t>(kSide), 0);
  LayerBits bits;

  OneBit(int x, int y, int level) {
    bits.owner = words;
    bits.bits.words = *words;
    bits.bits.width = kSide >> level;
    bits.bits.height = kSide >> level;
    bits.bits.words_per_row = 1;
    bits.bits.set(x, y);
    bits.level = level;
  }
};

Layer layerOf(LayerId id, std::vector<LayerBits> bits, std::vector<Mark> marks = {}) {
  Layer layer;
  layer.id = id;
  layer.style = {true, QColor(255, 0, 0), 1.0};
  layer.bits = std::move(bits);
  layer.marks = std::move(marks);
  return layer;
}

class ImageViewTest : public ::testing::Test {
 protected:
  ImageViewTest() {
    view_.resize(640, 640);
    view_.setImage(grayImage());
    for (int i = 0; i < kLayerCount; ++i)
      view_.setStyle(static_cast<LayerId>(i), {false, Qt::red, 1.0});
    view_.show();
  }

  QColor at(const QPointF& pixel) {
    const QImage picture = view_.grab().toImage();
    const QPointF place = view_.transform().toWidget(pixel) * picture.devicePixelRatio();
    return picture.pixelColor(place.toPoint());
  }

  void wheel(const QPointF& place, int notches) {
    QWheelEvent event(place, view_.mapToGlobal(place.toPoint()), QPoint(), QPoint(0, 120 * notches),
                      Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&view_, &event);
  }

  ImageView view_;
};

TEST_F(ImageViewTest, View_FitsTheWidgetUntilZoomed) {
  EXPECT_DOUBLE_EQ(view_.transform().scale(), 10.0);
  view_.resize(320, 320);
  QCoreApplication::processEvents();
  EXPECT_DOUBLE_EQ(view_.transform().scale(), 5.0);
  wheel({10.0, 10.0}, 1);
  const double zoomed = view_.transform().scale();
  view_.resize(300, 300);
  QCoreApplication::processEvents();
  EXPECT_DOUBLE_EQ(view_.transform().scale(), zoomed);
}

TEST_F(ImageViewTest, ASetBitCoversItsPixelAndNoOther) {
  const OneBit bit(20, 30, 0);
  view_.setLayer(layerOf(LayerId::kSeedEdges, {bit.bits}));
  for (const double scale : {8.0, 10.0, 21.7}) {
    view_.fit();
    ViewTransform transform = view_.transform();
    transform.zoomAt(transform.toWidget(QPointF(20.0, 30.0)), scale);
    view_.setTransform(transform);
    // 0.1 px inside and outside the border on all four sides.
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_EQ(at({20.0 + sign * 0.35, 30.0}), QColor(255, 0, 0)) << scale;
      EXPECT_EQ(at({20.0, 30.0 + sign * 0.35}), QColor(255, 0, 0)) << scale;
      EXPECT_EQ(at({20.0 + sign * 0.65, 30.2}), QColor(40, 40, 40)) << scale;
      EXPECT_EQ(at({20.2, 30.0 + sign * 0.65}), QColor(40, 40, 40)) << scale;
    }
  }
}

TEST_F(ImageViewTest, ABitOfALevelCoversItsFourPixels) {
  const OneBit bit(5, 6, 1);
  view_.setLayer(layerOf(LayerId::kTestEdges, {bit.bits}));
  for (const int x : {10, 11}) {
    for (const int y : {12, 13}) EXPECT_EQ(at(QPointF(x, y)), QColor(255, 0, 0));
  }
  EXPECT_EQ(at({9.0, 12.0}), QColor(40, 40, 40));
  EXPECT_EQ(at({12.0, 13.0}), QColor(40, 40, 40));
  EXPECT_EQ(at({10.0, 11.0}), QColor(40, 40, 40));
  EXPECT_EQ(at({10.0, 14.0}), QColor(40, 40, 40));
}

/// A line of one pixel is whole at any reduction.
TEST_F(ImageViewTest, ReducedBitsDropNoPixel) {
  OneBit line(0, 30, 0);
  for (int x = 0; x < kSide; ++x) line.bits.bits.set(x, 30);
  view_.setLayer(layerOf(LayerId::kTestEdges, {line.bits}));
  for (const double scale : {0.35, 0.6, 0.9}) {
    ViewTransform transform = view_.transform();
    transform.zoomAt(transform.toWidget(QPointF(32.0, 30.0)), scale);
    view_.setTransform(transform);
    const QImage picture = view_.grab().toImage();
    const QPointF from = transform.toWidget(QPointF(0.0, 30.0));
    for (int x = static_cast<int>(from.x()) + 1; x < from.x() + 63 * scale - 1; ++x) {
      bool drawn = false;
      for (int y = static_cast<int>(from.y()) - 2; y <= from.y() + 2; ++y)
        drawn = drawn || picture.pixelColor(x, y).red() > 200;
      EXPECT_TRUE(drawn) << scale << ", column " << x;
    }
  }
}

/// A straight line from (x, y) to (x, y), px.
LinesPtr lineOf(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  sessions::EdgeLine line;
  line.places_px = {from, to};
  line.box_px.extend(from);
  line.box_px.extend(to);
  return std::make_shared<const sessions::EdgeLines>(sessions::EdgeLines{line});
}

class EdgeLinesOnImage : public ImageViewTest {
 protected:
  /// A layer with a line of its own look.
  void show(LayerId id, const LinesPtr& lines) {
    Layer layer;
    layer.id = id;
    layer.style = layerInfo(id).style;
    layer.style.visible = true;
    layer.lines = lines;
    view_.setLayer(std::move(layer));
  }
  QImage pictureAt(double scale, const QPointF& centre) {
    ViewTransform transform = view_.transform();
    transform.zoomAt({}, scale);
    transform.centreOn(centre, view_.size());
    view_.setTransform(transform);
    return view_.grab().toImage();
  }
};

/// Zigzags over the whole image: more than are drawn at once.
LinesPtr manyLines() {
  sessions::EdgeLines lines;
  for (int row = 0; row < kSide; ++row) {
    sessions::EdgeLine& line = lines.emplace_back();
    for (int i = 0; i < 1'000; ++i) {
      const Eigen::Vector2d place(kSide * i / 1'000.0, row + 0.4 * (i % 2));
      line.places_px.push_back(place);
      line.box_px.extend(place);
    }
  }
  return std::make_shared<const sessions::EdgeLines>(lines);
}

/// A mark of each shape across the height, whose parts lie in several bands.
std::vector<Mark> manyMarks() {
  std::vector<Mark> marks;
  for (int i = 0; i <= static_cast<int>(MarkShape::kStrip); ++i) {
    Mark& mark = marks.emplace_back();
    mark.shape = static_cast<MarkShape>(i);
    mark.at = QPointF(5.0 * i + 2.0, 5.0 * i + 4.0);
    mark.to = QPointF(60.0 - 3.0 * i, 33.0);
    mark.area = QRectF(3.0, 3.0, 50.0, 57.0);
    mark.outline = QPolygonF({{40.0, 2.0}, {44.0, 60.0}, {46.0, 60.0}, {42.0, 2.0}});
    mark.label = QStringLiteral("p%1").arg(i);
    mark.cased = true;
  }
  return marks;
}

/// Pictures of bits take their time by the size that they have on the screen.
TEST_F(ImageViewTest, ManyBitImagesAreDrawnInSteps) {
  view_.resize(1400, 1000);
  const OneBit bit(20, 30, 0);
  view_.setLayer(layerOf(LayerId::kAgreement, std::vector<LayerBits>(9, bit.bits)));
  ASSERT_TRUE(QTest::qWaitFor([this] { return view_.isDrawn(); }));
  wheel({700.0, 500.0}, 1);
  view_.repaint();
  EXPECT_FALSE(view_.isDrawn()) << "one event does not draw all";
  ASSERT_TRUE(QTest::qWaitFor([this] { return view_.isDrawn(); }));
  EXPECT_EQ(at({20.0, 30.0}), QColor(255, 0, 0));
}

TEST_F(EdgeLinesOnImage, ManyLinesAreDrawnInStepsWhileTheFormerPictureIsShown) {
  show(LayerId::kTruthEdges, manyLines());
  view_.setLayer(layerOf(LayerId::kMatches, {}, manyMarks()));
  ASSERT_TRUE(QTest::qWaitFor([this] { return view_.isDrawn(); }));
  const QColor middle = at({32.0, 32.2});
  wheel({320.0, 320.0}, 2);
  view_.repaint();
  EXPECT_FALSE(view_.isDrawn()) << "one event does not draw all";
  EXPECT_EQ(at({32.0, 32.2}), middle) << "the former picture lies where its pixels are now";
  ASSERT_TRUE(QTest::qWaitFor([this] { return view_.isDrawn(); }));
  const QImage in_steps = view_.grab().toImage();
  ImageView other;  // which has nothing to show meanwhile, and draws at once
  other.resize(view_.size());
  other.setImage(grayImage());
  for (int i = 0; i < kLayerCount; ++i)
    other.setStyle(static_cast<LayerId>(i), {false, Qt::red, 1.0});
  for (const LayerId id : {LayerId::kTruthEdges, LayerId::kMatches})
    other.setLayer(view_.layer(id));
  other.setTransform(view_.transform());
  const QImage at_once = other.grab().toImage();
  ASSERT_EQ(in_steps.size(), at_once.size());
  int differ = 0;
  for (int y = 0; y < at_once.height(); ++y)
    for (int x = 0; x < at_once.width(); ++x)
      if (std::abs(qGray(in_steps.pixel(x, y)) - qGray(at_once.pixel(x, y))) > 8) ++differ;
  EXPECT_EQ(differ, 0);
}

/// At ten times, where the line's own colour is strongest across it.
TEST_F(EdgeLinesOnImage, AtTenTimesTheyLieWithinATenthOfAPixel) {
  for (const double y : {20.0, 20.13, 20.5, 20.77}) {
    show(LayerId::kIterationEdges, lineOf({10.0, y}, {40.0, y}));
    const QImage picture = pictureAt(10.0, {25.0, 20.0});
    const double column = view_.transform().toWidget(QPointF(25.0, y)).x();
    double weight = 0.0;
    double sum = 0.0;
    for (int row = 0; row < picture.height(); ++row) {
      const QColor color = picture.pixelColor(static_cast<int>(column), row);
      const double blue = std::max(0, color.blue() - color.red() - 40);
      weight += blue;
      sum += blue * (row + 0.5);
    }
    ASSERT_GT(weight, 0.0);
    const double seen = view_.transform().toPixel(QPointF(column, sum / weight)).y();
    EXPECT_NEAR(seen, y, 0.1);
  }
}

TEST_F(EdgeLinesOnImage, AtAThirdNoneOfALineIsLost) {
  show(LayerId::kIterationEdges, lineOf({2.3, 3.1}, {60.2, 47.9}));
  const QImage picture = pictureAt(0.35, {32.0, 32.0});
  for (double share = 0.02; share < 0.98; share += 0.01) {
    const QPointF place =
        view_.transform().toWidget(QPointF(2.3 + share * 57.9, 3.1 + share * 44.8));
    int bluest = 0;
    for (int v = -1; v <= 1; ++v)
      for (int u = -1; u <= 1; ++u) {
        const QColor color =
            picture.pixelColor(static_cast<int>(place.x()) + u, static_cast<int>(place.y()) + v);
        bluest = std::max(bluest, color.blue() - color.red());
      }
    EXPECT_GT(bluest, 60) << share;
  }
}

TEST_F(EdgeLinesOnImage, WidthIsTheSameAtEveryZoom) {
  show(LayerId::kIterationEdges, lineOf({-1000.0, 20.0}, {1000.0, 20.0}));
  std::vector<int> colored;
  for (const double scale : {0.3, 1.0, 10.0, 60.0}) {
    const QImage picture = pictureAt(scale, {20.0, 20.0});
    int count = 0;
    for (int row = 0; row < picture.height(); ++row) {
      const QColor color = picture.pixelColor(320, row);
      if (color.blue() > color.red() + 40) ++count;
    }
    colored.push_back(count);
  }
  for (const int count : colored) EXPECT_NEAR(count, colored.front(), 1);
}

/// With eyes that see no colour.
TEST_F(EdgeLinesOnImage, PosesDifferInTheirPattern) {
  const auto gapsOf = [this](LayerId id) {
    show(id, lineOf({0.0, 20.0}, {63.0, 20.0}));
    const QImage picture = pictureAt(10.0, {32.0, 20.0});
    view_.setStyle(id, {false, Qt::red, 1.0});
    const int row = static_cast<int>(view_.transform().toWidget(QPointF(32.0, 20.0)).y());
    int gaps = 0;
    for (int x = 21; x < 620; ++x) {
      const bool was = picture.pixelColor(x - 1, row).value() > 100;
      if (was && picture.pixelColor(x, row).value() <= 100) ++gaps;
    }
    return gaps;
  };
  EXPECT_EQ(gapsOf(LayerId::kIterationEdges), 0);
  EXPECT_NEAR(gapsOf(LayerId::kSeedEdges), 600.0 / 14.0, 2.0);
}

TEST_F(ImageViewTest, BlinkHidesAndSwipeCutsTheLayers) {
  const OneBit left(10, 10, 0);
  view_.setLayer(layerOf(LayerId::kTestEdges, {left.bits}));
  const OneBit right(50, 10, 0);
  view_.setLayer(layerOf(LayerId::kSeedEdges, {right.bits}));
  view_.setLayersHidden(true);
  EXPECT_EQ(at({10.0, 10.0}), QColor(40, 40, 40));
  view_.setLayersHidden(false);
  view_.setSwipe(0.5);
  EXPECT_EQ(at({10.0, 10.0}), QColor(255, 0, 0));
  EXPECT_EQ(at({50.0, 10.0}), QColor(40, 40, 40));
}

TEST_F(ImageViewTest, ADragOfTheSwipeLineMovesItAndNotTheImage) {
  view_.setSwipe(0.5);
  const ViewTransform before = view_.transform();
  QSignalSpy moved(&view_, &ImageView::swipeMoved);
  QTest::mousePress(&view_, Qt::LeftButton, Qt::NoModifier, {321, 100});
  QMouseEvent move(QEvent::MouseMove, QPointF(160.0, 120.0), view_.mapToGlobal(QPoint(160, 120)),
                   Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&view_, &move);
  QTest::mouseRelease(&view_, Qt::LeftButton, Qt::NoModifier, {160, 120});
  EXPECT_NEAR(*view_.swipe(), 0.25, 0.01);
  EXPECT_EQ(view_.transform(), before);
  EXPECT_EQ(moved.size(), 1);
}

/// What is kept as drawn is drawn again whenever it has to be.
TEST_F(ImageViewTest, PictureIsThatOfAViewThatIsDrawnForTheFirstTime) {
  const OneBit bit(20, 30, 0);
  const std::vector<std::function<void(ImageView&)>> acts = {
      [](ImageView& view) { view.resize(500, 400); },
      [](ImageView& view) { view.setImage(grayImage()); },
      [&](ImageView& view) { view.setLayer(layerOf(LayerId::kTestEdges, {bit.bits})); },
      [](ImageView& view) {
        view.setStyle(LayerId::kTestEdges, {true, Qt::green, 0.5});
      },
      [](ImageView& view) {
        view.centreOn({20.0, 30.0}, 40.0);
      },
      [](ImageView& view) { view.setLinkedCursor(QPointF(21.0, 31.0)); },
      [](ImageView& view) { view.setSwipe(0.5); },
      [](ImageView& view) { view.setSwipe(std::nullopt); },
      [](ImageView& view) { view.setLayersHidden(true); },
      [](ImageView& view) { view.setLayersHidden(false); },
      [](ImageView& view) { view.resize(420, 430); },
      [](ImageView& view) { view.setPalette(QPalette(Qt::black)); },
      [](ImageView& view) { view.setImage({}); },
      [](ImageView& view) { view.setHint(QStringLiteral("Drop an image")); },
  };
  ImageView used;
  used.show();
  for (std::size_t count = 1; count <= acts.size(); ++count) {
    acts[count - 1](used);
    ImageView first;
    first.show();
    for (std::size_t i = 0; i < count; ++i) acts[i](first);
    EXPECT_EQ(used.grab().toImage(), first.grab().toImage()) << "after act " << count;
  }
}

TEST_F(ImageViewTest, HHeldHidesTheLayers) {
  QTest::keyPress(&view_, Qt::Key_H);
  EXPECT_TRUE(view_.layersHidden());
  QTest::keyRelease(&view_, Qt::Key_H);
  EXPECT_FALSE(view_.layersHidden());
}

TEST_F(ImageViewTest, TheWheelZoomsAtTheCursor) {
  const QPointF place(200.0, 420.0);
  const QPointF pixel = view_.transform().toPixel(place);
  wheel(place, 3);
  EXPECT_GT(view_.transform().scale(), 15.0);
  const QPointF back = view_.transform().toPixel(place);
  EXPECT_LT(std::hypot(back.x() - pixel.x(), back.y() - pixel.y()), 1e-9);
}

TEST_F(ImageViewTest, AClickTellsThePixelUnderTheMiddleOfItsScreenPixel) {
  QSignalSpy clicks(&view_, &ImageView::clicked);
  const QPoint place(333, 127);
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  ASSERT_EQ(clicks.size(), 1);
  const QPointF pixel = clicks[0][0].toPointF();
  const QPointF back = view_.transform().toWidget(pixel);
  const double half = 0.5 / view_.devicePixelRatioF();
  EXPECT_NEAR(back.x(), place.x() + half, 1e-9);
  EXPECT_NEAR(back.y(), place.y() + half, 1e-9);
}

TEST_F(ImageViewTest, ADragMovesTheImageAndIsNoClick) {
  QSignalSpy clicks(&view_, &ImageView::clicked);
  const QPointF before = view_.transform().toWidget(QPointF(0.0, 0.0));
  QTest::mousePress(&view_, Qt::LeftButton, Qt::NoModifier, {100, 100});
  QMouseEvent move(QEvent::MouseMove, QPointF(150.0, 120.0), view_.mapToGlobal(QPoint(150, 120)),
                   Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&view_, &move);
  QTest::mouseRelease(&view_, Qt::LeftButton, Qt::NoModifier, {150, 120});
  const QPointF after = view_.transform().toWidget(QPointF(0.0, 0.0));
  EXPECT_EQ((after - before).toPoint(), QPoint(50, 20));
  EXPECT_EQ(clicks.size(), 0);
}

TEST_F(ImageViewTest, AClickPicksTheNearestMarkOfAVisibleLayer) {
  Mark near;
  near.at = {20.0, 20.0};
  near.item = 3;
  Mark nearer = near;
  nearer.at = {20.4, 20.0};
  nearer.item = 4;
  Mark unpickable = near;
  unpickable.at = {20.3, 20.0};
  unpickable.item = -1;
  view_.setLayer(layerOf(LayerId::kMatches, {}, {near, nearer, unpickable}));
  QSignalSpy picks(&view_, &ImageView::itemClicked);
  const QPoint place = view_.transform().toWidget(QPointF(21.1, 20.0)).toPoint();
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  ASSERT_EQ(picks.size(), 1);
  EXPECT_EQ(picks[0][1].toInt(), 4);
  view_.setStyle(LayerId::kMatches, {false, Qt::red, 1.0});
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  EXPECT_EQ(picks.size(), 1) << "a hidden layer is not picked";
  EXPECT_FALSE(view_.pickAt(QPointF(600.0, 600.0)).has_value());
}

TEST_F(ImageViewTest, AnArrowIsPickedAlongItsWholeLength) {
  Mark arrow;
  arrow.shape = MarkShape::kArrow;
  arrow.at = {10.0, 10.0};
  arrow.to = {40.0, 10.0};
  arrow.item = 9;
  view_.setLayer(layerOf(LayerId::kMatches, {}, {arrow}));
  const auto pick = view_.pickAt(view_.transform().toWidget(QPointF(25.0, 10.2)));
  ASSERT_TRUE(pick.has_value());
  EXPECT_EQ(pick->item, 9);
}

TEST_F(ImageViewTest, ADoubleClickFitsAndKeysZoom) {
  wheel({10.0, 10.0}, 5);
  QTest::mouseDClick(&view_, Qt::LeftButton, Qt::NoModifier, {300, 300});
  EXPECT_DOUBLE_EQ(view_.transform().scale(), 10.0);
  QTest::keyClick(&view_, Qt::Key_1);
  EXPECT_DOUBLE_EQ(view_.transform().scale(), 1.0 / view_.devicePixelRatioF());
  QTest::keyClick(&view_, Qt::Key_Plus);
  EXPECT_GT(view_.transform().scale(), 1.0 / view_.devicePixelRatioF());
  QTest::keyClick(&view_, Qt::Key_0);
  EXPECT_DOUBLE_EQ(view_.transform().scale(), 10.0);
}

TEST_F(ImageViewTest, AnEmptyViewTakesEveryEvent) {
  ImageView empty;
  empty.resize(100, 100);
  empty.show();
  QSignalSpy clicks(&empty, &ImageView::clicked);
  QTest::mouseClick(&empty, Qt::LeftButton);
  QTest::keyClick(&empty, Qt::Key_1);
  empty.fit();
  EXPECT_EQ(clicks.size(), 0);
  EXPECT_FALSE(empty.grab().isNull());
}

}  // namespace
}  // namespace boresight::ui
