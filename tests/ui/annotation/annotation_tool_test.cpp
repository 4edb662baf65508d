// SPDX-License-Identifier: Apache-2.0
// Run at a screen scaling of one and of one and a half.
#include "ui/annotation/annotation_tool.h"

#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/image_annotation.h"

namespace boresight::ui {
namespace {

const Eigen::Vector2d kMiddle(200.3, 150.7);

class AnnotationToolTest : public ImageAnnotationTest {
 protected:
  void SetUp() override {
    ImageAnnotationTest::SetUp();
    controller_.setMode(PlaceMode::kPoint);
  }
  Eigen::Vector2d place(const std::string& id) {
    const sessions::PointPair* point = sessions::findPoint(annotations(), id);
    return point && point->pixel ? *point->pixel : Eigen::Vector2d(-1e9, -1e9);
  }
  /// Annotations p1 where it is clicked; its place.
  Eigen::Vector2d markMiddle() {
    tool().setSnaps(false);
    zoom(kMiddle, 3.7);
    click(kMiddle);
    return place("p1");
  }
};

/// Gray of a picture with soft borders: its mean over each pixel.
template <class Inside>
double covered(int x, int y, const Inside& inside) {
  constexpr int kParts = 8;
  int count = 0;
  for (int j = 0; j < kParts; ++j)
    for (int i = 0; i < kParts; ++i)
      if (inside(Eigen::Vector2d(x - 0.5 + (i + 0.5) / kParts, y - 0.5 + (j + 0.5) / kParts)))
        ++count;
  return 40.0 + 160.0 * count / (kParts * kParts);
}

class PlacingTest : public AnnotationToolTest, public testing::WithParamInterface<double> {};

TEST_P(PlacingTest, Click_AnnotatesThePointUnderThePointer) {
  tool().setSnaps(false);
  int count = 0;
  for (const Eigen::Vector2d& off :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.31, 0.47), Eigen::Vector2d(-0.27, 0.05)}) {
    const Eigen::Vector2d wanted = kMiddle + off + Eigen::Vector2d(count * 60.0 / GetParam(), 0.0);
    zoom(kMiddle, GetParam());
    click(wanted);
    ASSERT_EQ(annotations().points.size(), static_cast<std::size_t>(++count));
    const Eigen::Vector2d error = *annotations().points.back().pixel - wanted;
    EXPECT_LE(error.cwiseAbs().maxCoeff(), (0.5 + 1e-6) * screenPixel_px());
  }
}

INSTANTIATE_TEST_SUITE_P(Zooms, PlacingTest, testing::Values(1.0, 3.7, 16.0));

TEST_F(AnnotationToolTest, Snapping_FindsCornerEllipseAndEdgeAndCanBeDisabled) {
  const Eigen::Vector2d corner(120.25, 90.6), centre(260.4, 150.3);
  const double edge_x = 60.35;
  paintImage([&](int x, int y) {
    return covered(x, y, [&](const Eigen::Vector2d& p) {
      const Eigen::Vector2d q = (p - centre).cwiseQuotient(Eigen::Vector2d(11.0, 8.0));
      const bool in_corner = p.x() > corner.x() && p.y() > corner.y() && p.x() < corner.x() + 70.0;
      return in_corner || q.squaredNorm() < 1.0 || p.x() < edge_x;
    });
  });
  zoom({160.0, 120.0}, 2.0);
  const auto aimed = [&](const Eigen::Vector2d& pixel) -> const AnnotationAim& {
    moveTo(pixel);
    return tool().aim();
  };
  const AnnotationAim at_corner = aimed(corner + Eigen::Vector2d(1.5, 1.0));
  ASSERT_TRUE(at_corner.snap);
  EXPECT_EQ(at_corner.snap->kind, sessions::ImageSnapKind::kCorner);
  EXPECT_LT((at_corner.pixel - corner).norm(), 0.35) << "blur rounds a corner";
  EXPECT_EQ(at_corner.text, QStringLiteral("corner"));
  const AnnotationAim at_ellipse = aimed(centre + Eigen::Vector2d(-2.0, 1.0));
  ASSERT_TRUE(at_ellipse.snap);
  EXPECT_EQ(at_ellipse.snap->kind, sessions::ImageSnapKind::kEllipse);
  EXPECT_LT((at_ellipse.pixel - centre).norm(), 0.1);
  const AnnotationAim at_edge = aimed({edge_x + 3.0, 200.0});
  ASSERT_TRUE(at_edge.snap);
  EXPECT_EQ(at_edge.snap->kind, sessions::ImageSnapKind::kEdge);
  EXPECT_NEAR(at_edge.pixel.x(), edge_x, 0.1);
  EXPECT_NEAR(at_edge.pixel.y(), 200.0, 0.6);

  const Eigen::Vector2d near = centre + Eigen::Vector2d(-2.0, 1.0);
  click(near);
  EXPECT_LT((place("p1") - centre).norm(), 0.1);
  click(near + Eigen::Vector2d(8.0, 8.0), Qt::AltModifier);
  EXPECT_LT((place("p2") - near - Eigen::Vector2d(8.0, 8.0)).norm(), screenPixel_px());
  tool().setSnaps(false);
  click({edge_x + 3.0, 200.0});
  EXPECT_NEAR(place("p3").x(), edge_x + 3.0, screenPixel_px());
}

TEST_F(AnnotationToolTest, Tab_SelectsTheNextSnapTarget) {
  const Eigen::Vector2d corner(120.25, 90.6);
  paintImage([&](int x, int y) {
    return covered(
        x, y, [&](const Eigen::Vector2d& p) { return p.x() > corner.x() && p.y() > corner.y(); });
  });
  zoom(corner, 4.0);
  const Eigen::Vector2d near = corner + Eigen::Vector2d(0.4, 1.2);
  moveTo(near);
  ASSERT_EQ(tool().aim().found, 2);
  EXPECT_EQ(tool().aim().snap->kind, sessions::ImageSnapKind::kCorner);
  QTest::keyClick(&view(), Qt::Key_Tab);
  EXPECT_EQ(tool().aim().snap->kind, sessions::ImageSnapKind::kEdge);
  click(near);
  EXPECT_GT(place("p1").y(), corner.y() + 0.9);
  controller_.remove("p1");
  moveTo(near);
  EXPECT_EQ(tool().aim().snap->kind, sessions::ImageSnapKind::kCorner) << "a new annotation starts";
}

TEST_F(AnnotationToolTest, Drag_MovesAnAnnotationWithoutAJumpAndIsOneUndoStep) {
  const Eigen::Vector2d before = markMiddle();
  // Grabbed off its centre.
  drag(before + Eigen::Vector2d(1.0, -0.7), before + Eigen::Vector2d(9.0, 3.3));
  EXPECT_LT((place("p1") - before - Eigen::Vector2d(8.0, 4.0)).norm(), 2.0 * screenPixel_px());
  EXPECT_EQ(annotations().points.size(), 1u);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Move p1"));
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(place("p1"), before);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Place p1 on the image"));
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(annotations().empty());
  ASSERT_TRUE(document_.redo());
  EXPECT_EQ(place("p1"), before);
}

TEST_F(AnnotationToolTest, EscapeWhileDragging_RestoresTheAnnotation) {
  const Eigen::Vector2d before = markMiddle();
  send(QEvent::MouseButtonPress, before);
  send(QEvent::MouseMove, before + Eigen::Vector2d(20.0, 0.0), Qt::NoModifier, Qt::LeftButton,
       true);
  EXPECT_GT(place("p1").x(), before.x() + 19.0);
  QTest::keyClick(&view(), Qt::Key_Escape);
  send(QEvent::MouseButtonRelease, before + Eigen::Vector2d(20.0, 0.0));
  EXPECT_EQ(place("p1"), before);
  EXPECT_EQ(annotations().points.size(), 1u);
}

TEST_F(AnnotationToolTest, LockedAnnotation_IsNotMovedAndReported) {
  const Eigen::Vector2d before = markMiddle();
  sessions::PointPair locked = *sessions::findPoint(annotations(), "p1");
  locked.locked = true;
  ASSERT_TRUE(controller_.replacePoint("p1", locked, QStringLiteral("Lock p1")));
  drag(before, before + Eigen::Vector2d(20.0, 0.0));
  EXPECT_EQ(place("p1"), before);
  EXPECT_TRUE(told_.contains(QStringLiteral("p1"))) << told_.toStdString();
  EXPECT_EQ(document_.undoText(), QStringLiteral("Lock p1"));
}

TEST_F(AnnotationToolTest, DragOffAnnotations_PansOnly) {
  zoom(kMiddle, 3.7);
  const QPointF before = view().transform().toWidget(QPointF(0.0, 0.0));
  drag(kMiddle, kMiddle + Eigen::Vector2d(30.0, 10.0));
  EXPECT_TRUE(annotations().empty());
  const QPointF by = view().transform().toWidget(QPointF(0.0, 0.0)) - before;
  EXPECT_GT(by.x(), 50.0);
  click(kMiddle);
  EXPECT_EQ(annotations().points.size(), 1u);
}

TEST_F(AnnotationToolTest, Arrows_MoveTheSelectedAnnotationByATenthOrAWholePixel) {
  const Eigen::Vector2d before = markMiddle();
  for (const int key : {Qt::Key_Right, Qt::Key_Right, Qt::Key_Down})
    QTest::keyClick(&view(), static_cast<Qt::Key>(key));
  EXPECT_LT((place("p1") - before - Eigen::Vector2d(0.2, 0.1)).norm(), 1e-9);
  QTest::keyClick(&view(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_LT((place("p1") - before - Eigen::Vector2d(-0.8, 0.1)).norm(), 1e-9);
  ASSERT_TRUE(annotation_.loupe().place());
  EXPECT_NEAR(annotation_.loupe().place()->x(), place("p1").x(), 1e-9) << "the loupe looks at it";
  controller_.select({});
  const QPointF shown = view().transform().toWidget(QPointF(0.0, 0.0));
  QTest::keyClick(&view(), Qt::Key_Left);
  EXPECT_NE(view().transform().toWidget(QPointF(0.0, 0.0)), shown)
      << "without a selected annotation the arrows pan";
}

TEST_F(AnnotationToolTest, PairsAreMadeInBothOrders) {
  state_.setNudgedPose(truth());  // what the views show
  const auto corners = corners_m(6);
  ASSERT_GE(corners.size(), 2u);
  const auto stationClick = [&](const Eigen::Vector3d& corner_m) {
    zoom(pixelOf(corner_m), 6.0);
    click(pixelOf(corner_m), Qt::ControlModifier);
  };
  tool().setSnaps(true);
  click(pixelOf(corners[0]), Qt::AltModifier);
  ASSERT_EQ(annotations().points.size(), 1u) << told_.toStdString();
  EXPECT_FALSE(annotations().points[0].complete());
  stationClick(corners[0]);
  ASSERT_EQ(annotations().points.size(), 1u);
  ASSERT_TRUE(annotations().points[0].complete());
  EXPECT_EQ(*annotations().points[0].point_in_station_m, corners[0]) << "snapped to the vertex";

  stationClick(corners[3]);
  ASSERT_EQ(annotations().points.size(), 2u);
  EXPECT_FALSE(annotations().points[1].pixel);
  EXPECT_EQ(*annotations().points[1].point_in_station_m, corners[3]);
  click(pixelOf(corners[3]), Qt::AltModifier);
  ASSERT_EQ(annotations().points.size(), 2u);
  EXPECT_TRUE(annotations().points[1].complete());
  EXPECT_LT((*annotations().points[1].pixel - pixelOf(corners[3])).norm(), screenPixel_px());
}

/// A hole's rim and its bottom have circles one behind the other.
TEST_F(AnnotationToolTest, StationAim_IsNamedWithItsHeight) {
  sessions::MeshSnap bottom;
  bottom.kind = sessions::MeshSnapKind::kCircle;
  bottom.point_in_station_m = {0.002, 0.003, -0.01};
  AimRules rules;
  rules.snaps = true;
  const AnnotationAim aim =
      aimAtStation(*state_.currentCase(), truth(), {1.0, 1.0}, {bottom}, rules);
  EXPECT_EQ(aim.text, QStringLiteral("circle centre, z -10.00 mm"));
}

TEST_F(AnnotationToolTest, WithoutSnappingTheStationsSurfaceIsAnnotated) {
  state_.setNudgedPose(truth());
  const auto corners = corners_m(3);
  const Eigen::Vector2d corner_px = pixelOf(corners[1]);
  zoom(corner_px, 6.0);
  tool().setSnaps(false);
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1),
                                     Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, -1)}) {
    click(corner_px + off, Qt::ControlModifier);
    if (!annotations().empty()) break;
  }
  ASSERT_EQ(annotations().points.size(), 1u);
  const Eigen::Vector3d placed = *annotations().points[0].point_in_station_m;
  EXPECT_NE(placed, corners[1]);
  EXPECT_LT((pixelOf(placed) - corner_px).norm(), 2.0);
}

TEST_F(AnnotationToolTest, CtrlClickOffTheStation_IsRefusedWithAReason) {
  click({1.0, 1.0}, Qt::ControlModifier);
  EXPECT_TRUE(annotations().empty());
  EXPECT_TRUE(told_.contains(QStringLiteral("not under the pointer"))) << told_.toStdString();
}

TEST_F(AnnotationToolTest, TwoClicksMakeALineAndCtrlClickItsEdge) {
  state_.setNudgedPose(truth());
  const auto corners = corners_m(5);
  controller_.setMode(PlaceMode::kLine);
  markMiddle();
  EXPECT_TRUE(annotations().lines.empty()) << "half drawn";
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kLine);
  click(kMiddle + Eigen::Vector2d(5.0, 0.0));
  click(kMiddle + Eigen::Vector2d(25.0, 7.0));
  ASSERT_EQ(annotations().lines.size(), 1u);
  const sessions::ImageLine line = *annotations().lines[0].line;
  EXPECT_LT((line.start - kMiddle - Eigen::Vector2d(5.0, 0.0)).norm(), screenPixel_px());
  EXPECT_LT((line.end - kMiddle - Eigen::Vector2d(25.0, 7.0)).norm(), screenPixel_px());
  zoom(pixelOf(corners[2]), 6.0);
  click(pixelOf(corners[2]), Qt::ControlModifier);
  ASSERT_TRUE(annotations().lines[0].complete());
  const sessions::ModelEdge edge = *annotations().lines[0].edge;
  EXPECT_LT(std::min((edge.start_in_station_m - corners[2]).norm(),
                     (edge.end_in_station_m - corners[2]).norm()),
            1e-9);
  // Its second end is dragged.
  zoom(line.end, 3.7);
  drag(line.end, line.end + Eigen::Vector2d(6.0, 0.0));
  EXPECT_EQ(annotations().lines[0].line->start, line.start);
  EXPECT_NEAR(annotations().lines[0].line->end.x(), line.end.x() + 6.0, 2.0 * screenPixel_px());
}

/// Otherwise Ctrl+Del would remove an annotation that the operator did not point at.
TEST_F(AnnotationToolTest, ClickThatStartsALine_ClearsTheSelection) {
  markMiddle();
  ASSERT_EQ(controller_.selected(), "p1");
  controller_.setMode(PlaceMode::kLine);
  click(kMiddle + Eigen::Vector2d(15.0 / view().transform().scale(), 0.0));  // just off the point
  EXPECT_EQ(controller_.selected(), "");
  EXPECT_EQ(annotations().points.size(), 1u);
}

TEST_F(AnnotationToolTest, IncompleteLine_StaysSelectedWhileDrawn) {
  state_.setNudgedPose(truth());
  controller_.setMode(PlaceMode::kLine);
  tool().setSnaps(false);
  const Eigen::Vector2d corner = pixelOf(corners_m(5)[2]);
  zoom(corner, 6.0);
  click(corner, Qt::ControlModifier);
  ASSERT_EQ(annotations().lines.size(), 1u);
  click(corner + Eigen::Vector2d(20.0, 0.0));
  click(corner + Eigen::Vector2d(20.0, 10.0));
  ASSERT_EQ(annotations().lines.size(), 1u);
  EXPECT_TRUE(annotations().lines[0].complete());
}

TEST_F(AnnotationToolTest, DeleteRemovesAndEscapeLeavesStepByStep) {
  markMiddle();
  click(kMiddle + Eigen::Vector2d(30.0, 0.0));
  QTest::keyClick(&view(), Qt::Key_Delete);
  ASSERT_EQ(annotations().points.size(), 1u);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Remove p2"));
  controller_.select("p1");
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_TRUE(controller_.selected().empty());
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
  click(kMiddle + Eigen::Vector2d(50.0, 20.0));
  EXPECT_EQ(annotations().points.size(), 1u) << "annotation mode is off";
}

TEST_F(AnnotationToolTest, PressOnAnAnnotation_SelectsItAndDoubleClickDoesNotFit) {
  markMiddle();
  click(kMiddle + Eigen::Vector2d(30.0, 0.0));
  EXPECT_EQ(controller_.selected(), "p2");
  click(place("p1"));
  EXPECT_EQ(controller_.selected(), "p1");
  EXPECT_EQ(annotations().points.size(), 2u);
  const ViewTransform before = view().transform();
  send(QEvent::MouseButtonDblClick, place("p1"));
  send(QEvent::MouseButtonRelease, place("p1"));
  EXPECT_EQ(view().transform(), before);
}

/// With three named points annotated, the others are proposed: a click annotates one there, the
/// right button begins it and the next click is its place.
TEST_F(AnnotationToolTest, ProposalClick_ConfirmsOrStartsAPair) {
  const auto corners = corners_m(8);
  ASSERT_GE(corners.size(), 6u);
  openLandmarks(corners, {0, 2, 5});
  ASSERT_TRUE(solved());
  ASSERT_GE(controller_.answer().proposals.size(), 2u);
  const auto far = [&](const sessions::Proposal& proposal) {
    zoom(proposal.pixel, 8.0);
    return proposal;
  };
  const sessions::Proposal first = far(controller_.answer().proposals[0]);
  const Eigen::Vector2d seen = first.pixel + Eigen::Vector2d(0.5, -0.25);
  click(seen, Qt::AltModifier);
  const sessions::PointPair* taken = sessions::findPoint(annotations(), first.landmark.name);
  ASSERT_TRUE(taken);
  EXPECT_LT((*taken->pixel - seen).norm(), screenPixel_px())
      << "where it was clicked: a prediction is no measurement";
  ASSERT_TRUE(solved());
  ASSERT_FALSE(controller_.answer().proposals.empty());
  const sessions::Proposal second = far(controller_.answer().proposals[0]);
  click(second.pixel, Qt::NoModifier, Qt::RightButton);
  const sessions::PointPair* begun = sessions::findPoint(annotations(), second.landmark.name);
  ASSERT_TRUE(begun);
  EXPECT_FALSE(begun->pixel);
  const Eigen::Vector2d by_hand = second.pixel + Eigen::Vector2d(0.5, 0.25);
  click(by_hand, Qt::AltModifier);
  begun = sessions::findPoint(annotations(), second.landmark.name);
  ASSERT_TRUE(begun && begun->pixel);
  EXPECT_LT((*begun->pixel - by_hand).norm(), screenPixel_px());
}

class ImageAnnotationLayersTest : public ImageAnnotationTest {
 protected:
  void show(LayerId id, bool visible) {
    LayerStyle style = panel_.style(id);
    style.visible = visible;
    panel_.setStyle(id, style);
  }
  const Layer& layer(LayerId id) { return view().layer(id); }
  bool wait(const std::function<bool()>& holds) { return QTest::qWaitFor(holds, kPatience_ms); }
  void annotateAndSolve() {
    markCorners(8);
    ASSERT_TRUE(solved());
    ASSERT_TRUE(controller_.solvedPose());
  }
};

TEST_F(ImageAnnotationLayersTest, TheSolvedPosesEdgesShow_AndTheStationIsPickedOnThoseThatShow) {
  EXPECT_TRUE(layer(LayerId::kAnnotationEdges).empty());
  annotateAndSolve();
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationEdges).empty(); }));
  EXPECT_EQ(tool().stationPose(), *controller_.solvedPose());
  show(LayerId::kAnnotationEdges, false);
  EXPECT_TRUE(layer(LayerId::kAnnotationEdges).empty());
  EXPECT_EQ(tool().stationPose(), state_.shownPose());
  show(LayerId::kAnnotationEdges, true);
  EXPECT_TRUE(wait([&] { return !layer(LayerId::kAnnotationEdges).empty(); }));
}

TEST_F(ImageAnnotationLayersTest, BlindRound_HidesAllThatAPosePredicts) {
  annotateAndSolve();
  for (const LayerId id : {LayerId::kMask, LayerId::kMatches, LayerId::kTestEdges}) show(id, true);
  controller_.putAside(QStringLiteral("Ada"));
  EXPECT_FALSE(tool().stationPose());
  EXPECT_FALSE(panel_.style(LayerId::kMask).visible || panel_.style(LayerId::kMatches).visible);
  EXPECT_TRUE(panel_.style(LayerId::kTestEdges).visible) << "they are the image's";
  show(LayerId::kMatches, true);
  EXPECT_FALSE(panel_.style(LayerId::kMatches).visible) << "its key does not show it either";
  EXPECT_FALSE(state_.knownPose()) << "nor the readout";
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(wait([&] {
    return panel_.style(LayerId::kMask).visible && panel_.style(LayerId::kMatches).visible;
  }));
  EXPECT_TRUE(state_.knownPose());
}

TEST_F(ImageAnnotationLayersTest, Band_FollowsTheCurrentAnnotations) {
  annotateAndSolve();
  EXPECT_TRUE(layer(LayerId::kAnnotationBand).marks.empty()) << "it is not switched on";
  show(LayerId::kAnnotationBand, true);
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationBand).marks.empty(); }));
  const auto before = layer(LayerId::kAnnotationBand).marks;
  const auto& moved = annotations().points.front();
  ASSERT_TRUE(controller_.dragInImage(moved.id, *moved.pixel + Eigen::Vector2d(1.5, 0.0)));
  EXPECT_TRUE(layer(LayerId::kAnnotationBand).marks.empty()) << "it is not known yet";
  controller_.finishMove();
  ASSERT_TRUE(solved());
  ASSERT_TRUE(wait([&] { return !layer(LayerId::kAnnotationBand).marks.empty(); }));
  // Annotations that agree less well allow more poses.
  const auto width = [](const std::vector<Mark>& signs) {
    const QPolygonF& outline = signs.front().outline;
    const QPointF across = outline.front() - outline.back();
    return std::hypot(across.x(), across.y());
  };
  EXPECT_GT(width(layer(LayerId::kAnnotationBand).marks), 2.0 * width(before));
}

TEST_F(ImageAnnotationLayersTest, ResidualsAreDrawnAsLongAsTheyAreMagnified) {
  annotateAndSolve();
  const auto& moved = annotations().points.front();
  ASSERT_TRUE(controller_.dragInImage(moved.id, *moved.pixel + Eigen::Vector2d(2.0, 0.0)));
  controller_.finishMove();
  ASSERT_TRUE(solved());
  const auto longest = [&] {
    double most = 0.0;
    for (const Mark& mark : layer(LayerId::kAnnotationResiduals).marks)
      most = std::max(most, std::hypot(mark.to.x() - mark.at.x(), mark.to.y() - mark.at.y()));
    return most;
  };
  EXPECT_EQ(layer(LayerId::kAnnotationResiduals).marks.size(), annotations().points.size());
  annotation_.setMagnification(1.0);
  const double plain_px = longest();
  EXPECT_GT(plain_px, 0.3);
  EXPECT_LT(plain_px, 2.5);
  for (const double factor : {10.0, 100.0}) {
    annotation_.setMagnification(factor);
    EXPECT_NEAR(longest(), factor * plain_px, 1e-6 * factor);
  }
}

TEST_F(ImageAnnotationLayersTest, ClickOnAnAnnotation_SelectsItOutsideAnnotationMode) {
  markCorners(3);
  controller_.select({});
  const auto& point = annotations().points[1];
  zoom(*point.pixel, 5.0);
  click(*point.pixel);
  EXPECT_EQ(controller_.selected(), point.id);
  EXPECT_EQ(annotations().points.size(), 3u);
}

}  // namespace
}  // namespace boresight::ui
