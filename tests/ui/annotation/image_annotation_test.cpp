// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/image_annotation.h"

#include "tests/ui/annotation/image_annotation_fixture.h"

namespace boresight::ui {
namespace {

class ImageAnnotationLayersTest : public ImageAnnotationTest {
 protected:
  void show(LayerId id, bool visible) {
    LayerStyle style = panel_.style(id);
    style.visible = visible;
    panel_.setStyle(id, style);
  }
  const Layer& layer(LayerId id) { return view().layer(id); }
  bool wait(const std::function<bool()>& holds) { return QTest::qWaitFor(holds, kPatience_ms); }
  void markAndSolve() {
    markCorners(8);
    ASSERT_TRUE(solved());
    ASSERT_TRUE(controller_.solvedPose());
  }
};

TEST_F(ImageAnnotationLayersTest, TheSolvedPosesEdgesShowAndGoWithTheirLayer) {
  EXPECT_TRUE(layer(LayerId::kAnnotationEdges).bits.empty());
  markAndSolve();
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationEdges).bits.empty(); }));
  show(LayerId::kAnnotationEdges, false);
  EXPECT_TRUE(layer(LayerId::kAnnotationEdges).bits.empty());
  show(LayerId::kAnnotationEdges, true);
  EXPECT_TRUE(wait([&] { return !layer(LayerId::kAnnotationEdges).bits.empty(); }));
}

TEST_F(ImageAnnotationLayersTest, TheStationIsPickedOnTheEdgesThatShow) {
  markAndSolve();
  EXPECT_EQ(tool().stationPose(), *controller_.solvedPose());
  show(LayerId::kAnnotationEdges, false);
  EXPECT_EQ(tool().stationPose(), state_.shownPose());
}

TEST_F(ImageAnnotationLayersTest, TheBandIsThatOfTheMarksAsTheyAreNow) {
  markAndSolve();
  EXPECT_TRUE(layer(LayerId::kAnnotationBand).marks.empty()) << "nobody asked for it";
  show(LayerId::kAnnotationBand, true);
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationBand).marks.empty(); }));
  const auto before = layer(LayerId::kAnnotationBand).marks;
  const auto& moved = marks().points.front();
  ASSERT_TRUE(controller_.dragInImage(moved.id, *moved.pixel + Eigen::Vector2d(1.5, 0.0)));
  EXPECT_TRUE(layer(LayerId::kAnnotationBand).marks.empty()) << "it is not known yet";
  controller_.finishMove();
  ASSERT_TRUE(solved());
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationBand).marks.empty(); }));
  // Marks that agree less well allow more poses.
  const auto width = [](const std::vector<Mark>& signs) {
    const QPolygonF& outline = signs.front().outline;
    const QPointF across = outline.front() - outline.back();
    return std::hypot(across.x(), across.y());
  };
  EXPECT_GT(width(layer(LayerId::kAnnotationBand).marks), 2.0 * width(before));
}

TEST_F(ImageAnnotationLayersTest, ResidualsAreDrawnAsLongAsTheyAreMagnified) {
  markAndSolve();
  const auto& moved = marks().points.front();
  ASSERT_TRUE(controller_.dragInImage(moved.id, *moved.pixel + Eigen::Vector2d(2.0, 0.0)));
  controller_.finishMove();
  ASSERT_TRUE(solved());
  const auto longest = [&] {
    double most = 0.0;
    for (const Mark& mark : layer(LayerId::kMarkResiduals).marks)
      most = std::max(most, std::hypot(mark.to.x() - mark.at.x(), mark.to.y() - mark.at.y()));
    return most;
  };
  EXPECT_EQ(layer(LayerId::kMarkResiduals).marks.size(), marks().points.size());
  annotation_.setMagnification(1.0);
  const double plain_px = longest();
  EXPECT_GT(plain_px, 0.3);
  EXPECT_LT(plain_px, 2.5);
  for (const double factor : {10.0, 100.0}) {
    annotation_.setMagnification(factor);
    EXPECT_NEAR(longest(), factor * plain_px, 1e-6 * factor);
  }
}

TEST_F(ImageAnnotationLayersTest, AClickOnAMarkChoosesItAlsoWhenNobodyAnnotates) {
  markCorners(3);
  controller_.select({});
  const auto& point = marks().points[1];
  zoom(*point.pixel, 5.0);
  click(*point.pixel);
  EXPECT_EQ(controller_.selected(), point.id);
  EXPECT_EQ(marks().points.size(), 3u);
}

}  // namespace
}  // namespace boresight::ui
