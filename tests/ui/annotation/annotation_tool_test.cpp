// SPDX-License-Identifier: Apache-2.0
// Run at a screen scaling of one and of one and a half.
#include "ui/annotation/annotation_tool.h"

#include "tests/ui/annotation/annotation_fixture.h"
#include "tests/ui/pixels.h"
#include "ui/annotation/image_annotation.h"

namespace boresight::ui {
namespace {

const Vector2d kMiddle(200.3, 150.7);

class AnnotationToolTest : public ImageAnnotationTest {
 protected:
  void SetUp() override {
    ImageAnnotationTest::SetUp();
    controller_.setMode(PlaceMode::kPoint);
  }
  Vector2d place(const std::string& id) {
    const sessions::PointPair* point = sessions::findPoint(annotations(), id);
    return point && point->pixel ? *point->pixel : Vector2d(-1e9, -1e9);
  }
  /// Annotates p1 where it is clicked; its place.
  Vector2d markMiddle() {
    tool().setSnaps(false);
    zoom(kMiddle, 3.7);
    click(kMiddle);
    return place("p1");
  }
  /// Points at a pixel, where a feature of this kind is found.
  AnnotationAim aimed(const Vector2d& pixel, sessions::ImageSnapKind kind) {
    moveTo(pixel);
    const AnnotationAim aim = tool().aim();
    EXPECT_TRUE(aim.snap && aim.snap->kind == kind) << aim.text.toStdString();
    return aim;
  }
};

class PlacingTest : public AnnotationToolTest, public testing::WithParamInterface<double> {};

TEST_P(PlacingTest, Click_AnnotatesThePointUnderThePointer) {
  tool().setSnaps(false);
  std::size_t count = 0;
  for (const Vector2d& off : {Vector2d(0.0, 0.0), Vector2d(0.31, 0.47), Vector2d(-0.27, 0.05)}) {
    const double aside = static_cast<double>(count) * 60.0 / GetParam();
    const Vector2d wanted = kMiddle + off + Vector2d(aside, 0.0);
    zoom(kMiddle, GetParam());
    click(wanted);
    ASSERT_EQ(annotations().points.size(), ++count);
    const Vector2d error = *annotations().points.back().pixel - wanted;
    EXPECT_LE(error.cwiseAbs().maxCoeff(), (0.5 + 1e-6) * screenPixel_px());
  }
}

INSTANTIATE_TEST_SUITE_P(Zooms, PlacingTest, testing::Values(1.0, 3.7, 16.0));

TEST_F(AnnotationToolTest, SnapsToCornerEllipseAndEdge_TabTakesTheNext_AndCanBeDisabled) {
  using sessions::ImageSnapKind;
  const Vector2d corner(120.25, 90.6), centre(260.4, 150.3);
  const double edge_x = 60.35;
  const auto inside = [&](const Vector2d& p) {
    const Vector2d q = (p - centre).cwiseQuotient(Vector2d(11.0, 8.0));
    const bool in_corner = p.x() > corner.x() && p.y() > corner.y() && p.x() < corner.x() + 70.0;
    return in_corner || q.squaredNorm() < 1.0 || p.x() < edge_x;
  };
  paintImage([&](int x, int y) {  // with soft borders: the mean over each pixel
    constexpr int kParts = 8;
    const int count = test::countPixels({kParts, kParts}, [&](int i, int j) {
      return inside({x - 0.5 + (i + 0.5) / kParts, y - 0.5 + (j + 0.5) / kParts});
    });
    return 40.0 + 160.0 * count / (kParts * kParts);
  });
  zoom(corner, 4.0);
  const Vector2d between = corner + Vector2d(0.4, 1.2);
  EXPECT_EQ(aimed(between, ImageSnapKind::kCorner).found, 2);
  QTest::keyClick(&view(), Qt::Key_Tab);
  EXPECT_EQ(tool().aim().snap->kind, ImageSnapKind::kEdge);
  click(between);
  EXPECT_GT(place("p1").y(), corner.y() + 0.9);
  controller_.remove("p1");
  aimed(between, ImageSnapKind::kCorner);  // a new annotation starts

  zoom({160.0, 120.0}, 2.0);
  const AnnotationAim at_corner = aimed(corner + Vector2d(1.5, 1.0), ImageSnapKind::kCorner);
  EXPECT_LT((at_corner.pixel - corner).norm(), 0.35) << "blur rounds a corner";
  EXPECT_EQ(at_corner.text, QStringLiteral("corner"));
  const Vector2d near = centre + Vector2d(-2.0, 1.0);
  EXPECT_LT((aimed(near, ImageSnapKind::kEllipse).pixel - centre).norm(), 0.1);
  const Vector2d at_edge = aimed({edge_x + 3.0, 200.0}, ImageSnapKind::kEdge).pixel;
  EXPECT_NEAR(at_edge.x(), edge_x, 0.1);
  EXPECT_NEAR(at_edge.y(), 200.0, 0.6);

  click(near);
  EXPECT_LT((place("p1") - centre).norm(), 0.1);
  click(near + Vector2d(8.0, 8.0), Qt::AltModifier);
  EXPECT_LT((place("p2") - near - Vector2d(8.0, 8.0)).norm(), screenPixel_px());
  tool().setSnaps(false);
  click({edge_x + 3.0, 200.0});
  EXPECT_NEAR(place("p3").x(), edge_x + 3.0, screenPixel_px());
}

TEST_F(AnnotationToolTest, Drag_MovesWithoutAJump_EscapeRestores_LockedAnnotationsStay) {
  zoom(kMiddle, 3.7);
  const QPointF origin = view().transform().toWidget(QPointF(0.0, 0.0));
  drag(kMiddle, kMiddle + Vector2d(30.0, 10.0));
  EXPECT_TRUE(annotations().empty()) << "off annotations it pans";
  EXPECT_GT((view().transform().toWidget(QPointF(0.0, 0.0)) - origin).x(), 50.0);

  const Vector2d before = markMiddle();
  // Grabbed off its centre.
  drag(before + Vector2d(1.0, -0.7), before + Vector2d(9.0, 3.3));
  EXPECT_LT((place("p1") - before - Vector2d(8.0, 4.0)).norm(), 2.0 * screenPixel_px());
  EXPECT_EQ(document_.undoText(), QStringLiteral("Move p1"));
  ASSERT_TRUE(document_.undo()) << "one step";
  EXPECT_EQ(place("p1"), before);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Place p1 on the image"));
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(annotations().empty());
  ASSERT_TRUE(document_.redo());
  EXPECT_EQ(place("p1"), before);

  const Vector2d away = before + Vector2d(20.0, 0.0);
  send(QEvent::MouseButtonPress, before);
  send(QEvent::MouseMove, away);
  EXPECT_GT(place("p1").x(), before.x() + 19.0);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Place p1 on the image")) << "not before its end";
  QTest::keyClick(&view(), Qt::Key_Escape);
  send(QEvent::MouseButtonRelease, away);
  EXPECT_EQ(place("p1"), before);

  sessions::PointPair locked = *sessions::findPoint(annotations(), "p1");
  locked.locked = true;
  ASSERT_TRUE(controller_.replacePoint("p1", locked, QStringLiteral("Lock p1")));
  drag(before, away);
  EXPECT_EQ(place("p1"), before);
  EXPECT_TRUE(test::has(told_, "p1"));
  EXPECT_EQ(document_.undoText(), QStringLiteral("Lock p1"));
  EXPECT_EQ(annotations().points.size(), 1u);
}

TEST_F(AnnotationToolTest, DragWhoseModeEnds_IsDropped_TheNextDragPans) {
  const Vector2d before = markMiddle();
  for (const PlaceMode meanwhile : {PlaceMode::kOff, PlaceMode::kLine}) {
    send(QEvent::MouseButtonPress, before);
    send(QEvent::MouseMove, before + Vector2d(10.0, 0.0));
    controller_.setMode(meanwhile);
    EXPECT_EQ(place("p1"), before);
    send(QEvent::MouseMove, before + Vector2d(20.0, 0.0));
    if (meanwhile == PlaceMode::kLine) send(QEvent::MouseButtonRelease, before);
    controller_.setMode(PlaceMode::kPoint);
    drag(kMiddle + Vector2d(20.0, 20.0), kMiddle + Vector2d(30.0, 20.0));
    EXPECT_EQ(place("p1"), before);
    EXPECT_EQ(document_.undoText(), QStringLiteral("Place p1 on the image"));
  }
}

/// A message box took the release of the button.
TEST_F(AnnotationToolTest, MoveWithoutAButton_EndsTheDragAndMovesNothing) {
  const Vector2d before = markMiddle();
  send(QEvent::MouseButtonPress, before);
  send(QEvent::MouseMove, before + Vector2d(10.0, 0.0));
  ASSERT_GT(place("p1").x(), before.x() + 9.0);
  moveTo(before + Vector2d(20.0, 7.0));
  EXPECT_EQ(place("p1"), before);
  moveTo(before + Vector2d(30.0, 14.0));
  EXPECT_EQ(place("p1"), before);
}

TEST_F(AnnotationToolTest, Arrows_MoveTheSelectedAnnotationByATenthOrAWholePixel) {
  const Vector2d before = markMiddle();
  for (const Qt::Key key : {Qt::Key_Right, Qt::Key_Right, Qt::Key_Down})
    QTest::keyClick(&view(), key);
  EXPECT_LT((place("p1") - before - Vector2d(0.2, 0.1)).norm(), 1e-9);
  QTest::keyClick(&view(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_LT((place("p1") - before - Vector2d(-0.8, 0.1)).norm(), 1e-9);
  ASSERT_TRUE(annotation_.loupe().place());
  EXPECT_NEAR(annotation_.loupe().place()->x(), place("p1").x(), 1e-9) << "the loupe looks at it";
  controller_.finishMove();
  ASSERT_TRUE(document_.undo()) << "quick nudges are one step";
  EXPECT_EQ(place("p1"), before);
  controller_.select({});
  const ViewTransform shown = view().transform();
  QTest::keyClick(&view(), Qt::Key_Left);
  EXPECT_FALSE(view().transform() == shown) << "without a selected annotation the arrows pan";
}

TEST_F(AnnotationToolTest, PairsAreMadeInBothOrders_NotOffTheStation) {
  state_.setNudgedPose(truth());  // what the views show
  const auto& points = annotations().points;
  click({1.0, 1.0}, Qt::ControlModifier);
  EXPECT_TRUE(points.empty());
  EXPECT_TRUE(test::has(told_, "not under the pointer"));
  const auto corners = corners_m(6);
  ASSERT_GE(corners.size(), 2u);
  const auto stationClick = [&](const Vector3d& corner_m) {
    zoom(pixelOf(corner_m), 6.0);
    click(pixelOf(corner_m), Qt::ControlModifier);
  };
  tool().setSnaps(true);
  click(pixelOf(corners[0]), Qt::AltModifier);
  ASSERT_EQ(points.size(), 1u) << told_.toStdString();
  EXPECT_FALSE(points[0].complete());
  stationClick(corners[0]);
  ASSERT_EQ(points.size(), 1u);
  ASSERT_TRUE(points[0].complete());
  EXPECT_EQ(*points[0].point_in_station_m, corners[0]) << "snapped to the vertex";

  stationClick(corners[3]);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_FALSE(points[1].pixel);
  EXPECT_EQ(*points[1].point_in_station_m, corners[3]);
  click(pixelOf(corners[3]), Qt::AltModifier);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_TRUE(points[1].complete());
  EXPECT_LT((*points[1].pixel - pixelOf(corners[3])).norm(), screenPixel_px());
}

/// A hole's rim and its bottom have circles one behind the other.
TEST_F(AnnotationToolTest, StationAim_IsNamedWithItsHeight) {
  sessions::MeshSnap bottom;
  bottom.kind = sessions::MeshSnapKind::kCircle;
  bottom.point_in_station_m = {0.002, 0.003, -0.01};
  const AnnotationAim aim =
      aimAtStation(*state_.currentCase(), truth(), {1.0, 1.0}, {bottom}, {.snaps = true});
  EXPECT_EQ(aim.text, QStringLiteral("circle centre, z -10.00 mm"));
}

TEST_F(AnnotationToolTest, WithoutSnappingTheStationsSurfaceIsAnnotated) {
  state_.setNudgedPose(truth());
  const auto corners = corners_m(3);
  const Vector2d corner_px = pixelOf(corners[1]);
  zoom(corner_px, 6.0);
  tool().setSnaps(false);
  for (const Vector2d& off : {Vector2d(1, 1), Vector2d(-1, 1), Vector2d(1, -1), Vector2d(-1, -1)})
    if (annotations().empty()) click(corner_px + off, Qt::ControlModifier);
  ASSERT_EQ(annotations().points.size(), 1u);
  const Vector3d placed = *annotations().points[0].point_in_station_m;
  EXPECT_NE(placed, corners[1]);
  EXPECT_LT((pixelOf(placed) - corner_px).norm(), 2.0);
}

TEST_F(AnnotationToolTest, TwoClicksMakeALineAndCtrlClickItsEdge_InEitherOrder) {
  state_.setNudgedPose(truth());
  const Vector3d corner_m = corners_m(5)[2];
  const auto& lines = annotations().lines;
  markMiddle();
  ASSERT_EQ(controller_.selected(), "p1");
  controller_.setMode(PlaceMode::kLine);
  click(kMiddle + Vector2d(15.0 / view().transform().scale(), 0.0));  // just off the point
  EXPECT_EQ(controller_.selected(), "") << "Ctrl+Del would remove what was not pointed at";
  EXPECT_TRUE(lines.empty()) << "half drawn";
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kLine);
  const Vector2d start = kMiddle + Vector2d(5.0, 0.0), end = kMiddle + Vector2d(25.0, 7.0);
  click(start);
  click(end);
  ASSERT_EQ(lines.size(), 1u);
  const sessions::ImageLine line = *lines[0].line;
  EXPECT_LT((line.start - start).norm(), screenPixel_px());
  EXPECT_LT((line.end - end).norm(), screenPixel_px());
  const Vector2d corner = pixelOf(corner_m);
  zoom(corner, 6.0);
  click(corner, Qt::ControlModifier);
  ASSERT_TRUE(lines[0].complete());
  const sessions::ModelEdge edge = *lines[0].edge;
  EXPECT_LT(std::min((edge.start_in_station_m - corner_m).norm(),
                     (edge.end_in_station_m - corner_m).norm()),
            1e-9);
  // Its second end is dragged.
  zoom(line.end, 3.7);
  drag(line.end, line.end + Vector2d(6.0, 0.0));
  EXPECT_EQ(lines[0].line->start, line.start);
  EXPECT_NEAR(lines[0].line->end.x(), line.end.x() + 6.0, 2.0 * screenPixel_px());

  // The edge of another one is annotated first; it stays selected while its line is drawn.
  zoom(corner, 6.0);
  click(corner, Qt::ControlModifier);
  ASSERT_EQ(lines.size(), 2u);
  click(corner + Vector2d(20.0, 0.0));
  click(corner + Vector2d(20.0, 10.0));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[1].complete());
  EXPECT_EQ(annotations().points.size(), 1u);
}

TEST_F(AnnotationToolTest, PressSelects_DoubleClickDoesNotFit_DeleteRemoves_EscapeLeavesByStep) {
  markMiddle();
  const Vector2d second = kMiddle + Vector2d(30.0, 0.0);
  click(second);
  EXPECT_EQ(controller_.selected(), "p2");
  click(place("p1"));
  EXPECT_EQ(controller_.selected(), "p1");
  EXPECT_EQ(annotations().points.size(), 2u);
  const ViewTransform before = view().transform();
  send(QEvent::MouseButtonDblClick, place("p1"));
  send(QEvent::MouseButtonRelease, place("p1"));
  EXPECT_EQ(view().transform(), before);
  controller_.select("p2");
  QTest::keyClick(&view(), Qt::Key_Delete);
  ASSERT_EQ(annotations().points.size(), 1u);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Remove p2"));
  controller_.select("p1");
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_TRUE(controller_.selected().empty());
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
  click(kMiddle + Vector2d(50.0, 20.0));
  EXPECT_EQ(annotations().points.size(), 1u) << "annotation mode is off";
}

/// With three named points annotated, the others are proposed: a click annotates one there, the
/// right button begins it and the next click is its place.
TEST_F(AnnotationToolTest, ProposalClick_ConfirmsOrStartsAPair) {
  const auto places_m = corners_m(8);
  std::vector<sessions::Landmark> landmarks;
  for (std::size_t i = 0; i < places_m.size(); ++i)
    landmarks.push_back({"corner " + std::to_string(i), places_m[i], ""});
  sessions::writeLandmarks(folder_ / "landmarks.json", landmarks);
  controller_.setLandmarksFile(folder_ / "landmarks.json");
  for (const std::size_t i : {0u, 3u, 7u}) {
    controller_.begin(landmarks.at(i));
    EXPECT_EQ(controller_.placeInImage(pixelOf(places_m[i])), landmarks[i].name);
  }
  const auto proposed = [&](std::size_t count) {
    EXPECT_TRUE(solved());
    EXPECT_EQ(controller_.answer().proposals.size(), count);
    const sessions::Proposal proposal = controller_.answer().proposals.at(0);
    zoom(proposal.pixel, 8.0);
    return proposal;
  };
  const sessions::Proposal first = proposed(5);
  EXPECT_EQ(controller_.seenProposals(), 5) << "all are corners that are seen";
  for (const sessions::Proposal& proposal : controller_.answer().proposals)
    EXPECT_LT((proposal.pixel - pixelOf(proposal.landmark.point_in_station_m)).norm(), 0.5);
  const Vector2d seen = first.pixel + Vector2d(0.5, -0.25);
  click(seen, Qt::AltModifier);
  EXPECT_LT((place(first.landmark.name) - seen).norm(), screenPixel_px())
      << "where it was clicked: a prediction is no measurement";
  EXPECT_EQ(controller_.selected(), first.landmark.name);
  const sessions::Proposal second = proposed(4);
  click(second.pixel, Qt::NoModifier, Qt::RightButton);
  const sessions::PointPair* begun = sessions::findPoint(annotations(), second.landmark.name);
  ASSERT_TRUE(begun);
  EXPECT_FALSE(begun->pixel);
  const Vector2d by_hand = second.pixel + Vector2d(0.5, 0.25);
  click(by_hand, Qt::AltModifier);
  EXPECT_LT((place(second.landmark.name) - by_hand).norm(), screenPixel_px());
}

class ImageAnnotationLayersTest : public ImageAnnotationTest {
 protected:
  void show(LayerId id, bool visible) {
    LayerStyle style = panel_.style(id);
    style.visible = visible;
    panel_.setStyle(id, style);
  }
  bool isOn(LayerId id) const { return panel_.style(id).visible; }
  const Layer& layer(LayerId id) { return view().layer(id); }
};

TEST_F(ImageAnnotationLayersTest, TheSolvedPosesEdgesShow_AndTheStationIsPickedOnThoseThatShow) {
  const Layer& edges = layer(LayerId::kAnnotationEdges);
  EXPECT_TRUE(edges.empty());
  solveCorners(8);
  ASSERT_TRUE(wait([&] { return !edges.empty(); }));
  EXPECT_EQ(tool().stationPose(), *controller_.solvedPose());
  show(LayerId::kAnnotationEdges, false);
  EXPECT_TRUE(edges.empty());
  EXPECT_EQ(tool().stationPose(), state_.shownPose());
  show(LayerId::kAnnotationEdges, true);
  EXPECT_TRUE(wait([&] { return !edges.empty(); }));
}

TEST_F(ImageAnnotationLayersTest, BlindRound_HidesAllThatAPosePredicts) {
  solveCorners(8);
  for (const LayerId id : {LayerId::kMask, LayerId::kMatches, LayerId::kTestEdges}) show(id, true);
  controller_.putAside(QStringLiteral("Ada"));
  EXPECT_FALSE(tool().stationPose());
  EXPECT_FALSE(isOn(LayerId::kMask) || isOn(LayerId::kMatches));
  EXPECT_TRUE(isOn(LayerId::kTestEdges)) << "they are the image's";
  show(LayerId::kMatches, true);
  EXPECT_FALSE(isOn(LayerId::kMatches)) << "its key does not show it either";
  EXPECT_FALSE(state_.knownPose()) << "nor the readout";
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(wait([&] { return isOn(LayerId::kMask) && isOn(LayerId::kMatches); }));
  EXPECT_TRUE(state_.knownPose());
}

TEST_F(ImageAnnotationLayersTest, BandAndResiduals_FollowTheCurrentAnnotations) {
  solveCorners(8);
  const std::vector<Mark>& band = layer(LayerId::kAnnotationBand).marks;
  EXPECT_TRUE(band.empty()) << "it is not switched on";
  show(LayerId::kAnnotationBand, true);
  ASSERT_TRUE(wait([&] { return !band.empty(); }));
  // Annotations that agree less well allow more poses.
  const auto bandWidth_px = [&] {
    const QPointF across = band.front().outline.front() - band.front().outline.back();
    return std::hypot(across.x(), across.y());
  };
  const double before_px = bandWidth_px();
  const sessions::PointPair moved = annotations().points.front();
  ASSERT_TRUE(controller_.dragInImage(moved.id, *moved.pixel + Vector2d(6.0, 0.0)));
  EXPECT_TRUE(band.empty()) << "it is not known yet";
  controller_.finishMove();
  ASSERT_TRUE(solved());
  ASSERT_TRUE(wait([&] { return !band.empty(); }));
  EXPECT_GT(bandWidth_px(), 2.0 * before_px);

  moveFirst({-4.0, 0.0});  // 2 px in all
  const std::vector<Mark>& residuals = layer(LayerId::kAnnotationResiduals).marks;
  EXPECT_EQ(residuals.size(), annotations().points.size());
  const auto longestAt = [&](double magnification) {
    annotation_.setMagnification(magnification);
    double most = 0.0;
    for (const Mark& mark : residuals)
      most = std::max(most, std::hypot(mark.to.x() - mark.at.x(), mark.to.y() - mark.at.y()));
    return most;
  };
  const double plain_px = longestAt(1.0);
  EXPECT_GT(plain_px, 0.3);
  EXPECT_LT(plain_px, 2.5);
  for (const double factor : {10.0, 100.0})
    EXPECT_NEAR(longestAt(factor), factor * plain_px, 1e-6 * factor);
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
