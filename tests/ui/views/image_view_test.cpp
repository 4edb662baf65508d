// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <QtTest>

#include "tests/ui/pixels.h"
#include "tests/ui/pointer.h"
#include "tests/ui/views/view_fixture.h"

namespace boresight::ui {
namespace {

constexpr int kSide = 64;
const QColor kGray(40, 40, 40);
const QColor kRed(255, 0, 0);

QImage grayImage() {
  QImage gray(kSide, kSide, QImage::Format_Grayscale8);
  gray.fill(40);
  return gray;
}

/// One bit set in a map of 64 x 64, at a level.
LayerBits oneBit(int x, int y, int level = 0) {
  const auto words = std::make_shared<std::vector<std::uint64_t>>(std::size_t{kSide}, 0);
  LayerBits map;
  map.owner = words;
  map.bits.words = *words;
  map.bits.width = map.bits.height = kSide >> level;
  map.bits.words_per_row = 1;
  map.bits.set(x, y);
  map.level = level;
  return map;
}

Layer layerOf(LayerId id, std::vector<LayerBits> bits, std::vector<Mark> marks = {}) {
  Layer layer;
  layer.id = id;
  layer.style = {true, kRed, 1.0};
  layer.bits = std::move(bits);
  layer.marks = std::move(marks);
  return layer;
}

class ImageViewTest : public ::testing::Test {
 protected:
  ImageViewTest() {
    view_.resize(640, 640);
    view_.setImage(grayImage());
    test::hideLayers(view_);
    view_.show();
  }

  QColor at(const QPointF& pixel) {
    const QImage picture = view_.grab().toImage();
    const QPointF place = view_.transform().toWidget(pixel) * picture.devicePixelRatio();
    return picture.pixelColor(place.toPoint());
  }
  double scale() const { return view_.transform().scale(); }
  bool drawn() {
    return QTest::qWaitFor([this] { return view_.isDrawn(); });
  }

  ImageView view_;
};

TEST_F(ImageViewTest, View_FitsTheWidgetUntilZoomed_WheelAndKeysZoom_ADoubleClickFits) {
  EXPECT_DOUBLE_EQ(scale(), 10.0);
  view_.resize(320, 320);
  QCoreApplication::processEvents();
  EXPECT_DOUBLE_EQ(scale(), 5.0);
  test::turnWheel(view_, {10.0, 10.0}, 1);
  const double zoomed = scale();
  for (const int side : {300, 640}) {
    view_.resize(side, side);
    QCoreApplication::processEvents();
    EXPECT_DOUBLE_EQ(scale(), zoomed);
  }
  QTest::mouseDClick(&view_, Qt::LeftButton, Qt::NoModifier, {300, 300});
  EXPECT_DOUBLE_EQ(scale(), 10.0);
  const QPointF cursor(200.0, 420.0);
  const QPointF pixel = view_.transform().toPixel(cursor);
  test::turnWheel(view_, cursor, 3);
  EXPECT_GT(scale(), 15.0);
  const QPointF back = view_.transform().toPixel(cursor);
  EXPECT_LT(std::hypot(back.x() - pixel.x(), back.y() - pixel.y()), 1e-9) << "it stays there";
  QTest::keyClick(&view_, Qt::Key_1);
  EXPECT_DOUBLE_EQ(scale(), 1.0 / view_.devicePixelRatioF());
  QTest::keyClick(&view_, Qt::Key_Plus);
  EXPECT_GT(scale(), 1.0 / view_.devicePixelRatioF());
  QTest::keyClick(&view_, Qt::Key_0);
  EXPECT_DOUBLE_EQ(scale(), 10.0);
}

TEST_F(ImageViewTest, ASetBitCoversItsPixelAndNoOther_OfALevelItsFourPixels) {
  view_.setLayer(layerOf(LayerId::kSeedEdges, {oneBit(20, 30)}));
  for (const double zoom : {8.0, 10.0, 21.7}) {
    view_.fit();
    test::zoomAt(view_, view_.transform().toWidget(QPointF(20.0, 30.0)), zoom);
    // 0.1 px inside and outside the border on all four sides.
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_EQ(at({20.0 + sign * 0.35, 30.0}), kRed) << zoom;
      EXPECT_EQ(at({20.0, 30.0 + sign * 0.35}), kRed) << zoom;
      EXPECT_EQ(at({20.0 + sign * 0.65, 30.2}), kGray) << zoom;
      EXPECT_EQ(at({20.2, 30.0 + sign * 0.65}), kGray) << zoom;
    }
  }
  view_.fit();
  view_.setLayer(layerOf(LayerId::kTestEdges, {oneBit(5, 6, 1)}));
  for (const QPointF& inside : {QPointF(10, 12), QPointF(10, 13), QPointF(11, 12), QPointF(11, 13)})
    EXPECT_EQ(at(inside), kRed);
  for (const QPointF& outside : {QPointF(9, 12), QPointF(12, 13), QPointF(10, 11), QPointF(10, 14)})
    EXPECT_EQ(at(outside), kGray);
}

/// A line of one pixel is whole at any reduction.
TEST_F(ImageViewTest, ReducedBitsDropNoPixel) {
  LayerBits line = oneBit(0, 30);
  for (int x = 0; x < kSide; ++x) line.bits.set(x, 30);
  view_.setLayer(layerOf(LayerId::kTestEdges, {line}));
  for (const double zoom : {0.35, 0.6, 0.9}) {
    test::zoomAt(view_, view_.transform().toWidget(QPointF(32.0, 30.0)), zoom);
    const QImage picture = view_.grab().toImage();
    const QPointF from = view_.transform().toWidget(QPointF(0.0, 30.0));
    for (int x = static_cast<int>(from.x()) + 1; x < from.x() + 63 * zoom - 1; ++x) {
      int reddest = 0;
      for (int y = static_cast<int>(from.y()) - 2; y <= from.y() + 2; ++y)
        reddest = std::max(reddest, picture.pixelColor(x, y).red());
      EXPECT_GT(reddest, 200) << zoom << ", column " << x;
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
  QImage pictureAt(double zoom, const QPointF& centre) {
    ViewTransform transform = view_.transform();
    transform.zoomAt({}, zoom);
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
  view_.setLayer(layerOf(LayerId::kAgreement, std::vector<LayerBits>(9, oneBit(20, 30))));
  ASSERT_TRUE(drawn());
  test::turnWheel(view_, {700.0, 500.0}, 1);
  view_.repaint();
  EXPECT_FALSE(view_.isDrawn()) << "one event does not draw all";
  ASSERT_TRUE(drawn());
  EXPECT_EQ(at({20.0, 30.0}), kRed);
}

TEST_F(EdgeLinesOnImage, ManyLinesAreDrawnInStepsWhileTheFormerPictureIsShown) {
  show(LayerId::kTruthEdges, manyLines());
  view_.setLayer(layerOf(LayerId::kMatches, {}, manyMarks()));
  ASSERT_TRUE(drawn());
  const QColor middle = at({32.0, 32.2});
  test::turnWheel(view_, {320.0, 320.0}, 2);
  view_.repaint();
  EXPECT_FALSE(view_.isDrawn()) << "one event does not draw all";
  EXPECT_EQ(at({32.0, 32.2}), middle) << "the former picture lies where its pixels are now";
  ASSERT_TRUE(drawn());
  const QImage in_steps = view_.grab().toImage();
  ImageView other;  // which has nothing to show meanwhile, and draws at once
  other.resize(view_.size());
  other.setImage(grayImage());
  test::hideLayers(other);
  for (const LayerId id : {LayerId::kTruthEdges, LayerId::kMatches})
    other.setLayer(view_.layer(id));
  other.setTransform(view_.transform());
  const QImage at_once = other.grab().toImage();
  ASSERT_EQ(in_steps.size(), at_once.size());
  const auto differ = [&](int x, int y) {
    return std::abs(qGray(in_steps.pixel(x, y)) - qGray(at_once.pixel(x, y))) > 8;
  };
  EXPECT_EQ(test::countPixels(at_once.size(), differ), 0);
}

/// At ten times, where the line's own colour is strongest across it.
TEST_F(EdgeLinesOnImage, AtTenTimesTheyLieWithinATenthOfAPixel) {
  for (const double y : {20.0, 20.13, 20.5, 20.77}) {
    show(LayerId::kIterationEdges, lineOf({10.0, y}, {40.0, y}));
    const QImage picture = pictureAt(10.0, {25.0, 20.0});
    const int column = static_cast<int>(view_.transform().toWidget(QPointF(25.0, y)).x());
    const QPointF centre = test::centroid(
        picture.copy(column, 0, 1, picture.height()), 0.0,
        [](const QPointF&, QRgb color) { return std::max(0, qBlue(color) - qRed(color) - 40); });
    const double seen = view_.transform().toPixel(QPointF(column, centre.y())).y();
    EXPECT_NEAR(seen, y, 0.1);
  }
}

TEST_F(EdgeLinesOnImage, AtAThirdNoneOfALineIsLost) {
  show(LayerId::kIterationEdges, lineOf({2.3, 3.1}, {60.2, 47.9}));
  const QImage picture = pictureAt(0.35, {32.0, 32.0});
  for (double share = 0.02; share < 0.98; share += 0.01) {
    const QPointF place =
        view_.transform().toWidget(QPointF(2.3 + share * 57.9, 3.1 + share * 44.8));
    const int x = static_cast<int>(place.x()) - 1, y = static_cast<int>(place.y()) - 1;
    const auto isBlue = [&](int u, int v) {
      const QRgb color = picture.pixel(x + u, y + v);
      return qBlue(color) - qRed(color) > 60;
    };
    EXPECT_GT(test::countPixels({3, 3}, isBlue), 0) << share;
  }
}

TEST_F(EdgeLinesOnImage, WidthIsTheSameAtEveryZoom) {
  show(LayerId::kIterationEdges, lineOf({-1000.0, 20.0}, {1000.0, 20.0}));
  const auto width = [this](double zoom) {
    const QImage picture = pictureAt(zoom, {20.0, 20.0});
    return test::countPixels({1, picture.height()}, [&](int, int row) {
      return picture.pixelColor(320, row).blue() > picture.pixelColor(320, row).red() + 40;
    });
  };
  for (const double zoom : {1.0, 10.0, 60.0}) EXPECT_NEAR(width(zoom), width(0.3), 1);
}

/// With eyes that see no colour.
TEST_F(EdgeLinesOnImage, PosesDifferInTheirPattern) {
  const auto gapsOf = [this](LayerId id) {
    show(id, lineOf({0.0, 20.0}, {63.0, 20.0}));
    const QImage picture = pictureAt(10.0, {32.0, 20.0});
    view_.setStyle(id, {false, Qt::red, 1.0});
    const int row = static_cast<int>(view_.transform().toWidget(QPointF(32.0, 20.0)).y());
    const auto bright = [&](int x) { return picture.pixelColor(x, row).value() > 100; };
    return test::countPixels({599, 1},
                             [&](int x, int) { return bright(20 + x) && !bright(21 + x); });
  };
  EXPECT_EQ(gapsOf(LayerId::kIterationEdges), 0);
  EXPECT_NEAR(gapsOf(LayerId::kSeedEdges), 600.0 / 14.0, 2.0);
}

TEST_F(ImageViewTest, HHeldHidesTheLayers_SwipeCutsThemAtALineThatCanBeDragged) {
  view_.setLayer(layerOf(LayerId::kTestEdges, {oneBit(10, 10)}));
  view_.setLayer(layerOf(LayerId::kSeedEdges, {oneBit(50, 10)}));
  QTest::keyPress(&view_, Qt::Key_H);
  EXPECT_TRUE(view_.layersHidden());
  EXPECT_EQ(at({10.0, 10.0}), kGray);
  QTest::keyRelease(&view_, Qt::Key_H);
  EXPECT_FALSE(view_.layersHidden());
  view_.setSwipe(0.5);
  EXPECT_EQ(at({10.0, 10.0}), kRed);
  EXPECT_EQ(at({50.0, 10.0}), kGray);
  const ViewTransform before = view_.transform();
  test::dragMouse(view_, {{321.0, 100.0}, {160.0, 120.0}});
  EXPECT_NEAR(*view_.swipe(), 0.25, 0.01);
  EXPECT_EQ(view_.transform(), before) << "the image stays";
}

/// What is kept as drawn is drawn again whenever it has to be.
TEST_F(ImageViewTest, PictureIsThatOfAViewThatIsDrawnForTheFirstTime) {
  const std::vector<std::function<void(ImageView&)>> acts = {
      [](ImageView& view) { view.resize(500, 400); },
      [](ImageView& view) { view.setImage(grayImage()); },
      [](ImageView& view) { view.setLayer(layerOf(LayerId::kTestEdges, {oneBit(20, 30)})); },
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

TEST_F(ImageViewTest, AClickTellsThePixelUnderTheMiddleOfItsScreenPixel_ADragMovesTheImage) {
  QSignalSpy clicks(&view_, &ImageView::clicked);
  const QPoint place(333, 127);
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  ASSERT_EQ(clicks.size(), 1);
  const QPointF back = view_.transform().toWidget(clicks[0][0].toPointF());
  const double half = 0.5 / view_.devicePixelRatioF();
  EXPECT_NEAR(back.x(), place.x() + half, 1e-9);
  EXPECT_NEAR(back.y(), place.y() + half, 1e-9);
  const QPointF before = view_.transform().toWidget(QPointF(0.0, 0.0));
  test::dragMouse(view_, {{100.0, 100.0}, {150.0, 120.0}});
  const QPointF after = view_.transform().toWidget(QPointF(0.0, 0.0));
  EXPECT_EQ((after - before).toPoint(), QPoint(50, 20));
  EXPECT_EQ(clicks.size(), 1) << "a drag is no click";
}

TEST_F(ImageViewTest, AClickPicksTheNearestMarkOfAVisibleLayer) {
  const auto markAt = [](double x, int item) {
    Mark mark;
    mark.at = {x, 20.0};
    mark.item = item;
    return mark;
  };
  view_.setLayer(layerOf(LayerId::kMatches, {},
                         {markAt(20.0, 3), markAt(20.4, 4), markAt(20.3, /*unpickable*/ -1)}));
  QSignalSpy picks(&view_, &ImageView::itemClicked);
  const QPoint place = view_.transform().toWidget(QPointF(21.1, 20.0)).toPoint();
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  ASSERT_EQ(picks.size(), 1);
  EXPECT_EQ(picks[0][1].toInt(), 4);
  view_.setStyle(LayerId::kMatches, {false, Qt::red, 1.0});
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place);
  EXPECT_EQ(picks.size(), 1) << "a hidden layer is not picked";
  EXPECT_FALSE(view_.pickAt(QPointF(600.0, 600.0)).has_value());
  Mark arrow = markAt(10.0, 9);  // is picked along its whole length
  arrow.shape = MarkShape::kArrow;
  arrow.to = {40.0, 20.0};
  view_.setLayer(layerOf(LayerId::kMatches, {}, {arrow}));
  const auto pick = view_.pickAt(view_.transform().toWidget(QPointF(25.0, 20.2)));
  ASSERT_TRUE(pick.has_value());
  EXPECT_EQ(pick->item, 9);
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
