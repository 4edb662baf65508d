// SPDX-License-Identifier: Apache-2.0
// Annotations placed with real mouse events in the scene, without OpenGL. Runs at a scaling of 1,
// and again with QT_SCALE_FACTOR=1.5.
#include <gtest/gtest.h>

#include <cmath>

#include "sessions/session/rig_links.h"
#include "tests/sessions/annotation/box_scene.h"
#include "tests/ui/annotation/annotation_fixture.h"
#include "tests/ui/pixels.h"
#include "ui/annotation/station_snapper.h"
#include "ui/scene/scene_annotator.h"
#include "ui/scene/scene_view.h"

namespace boresight::ui {
namespace {

struct Box : test::BoxScene {
  const sessions::SceneMesh& scene() const { return scene_; }
};

const Vector3d kCorner_m = Eigen::Vector3f(0.1F, -0.1F, 0.0F).cast<double>();
const Vector3d kNextCorner_m = Eigen::Vector3f(0.1F, 0.1F, 0.0F).cast<double>();
const Vector3d kHiddenCorner_m = Eigen::Vector3f(-0.1F, 0.1F, -0.04F).cast<double>();
const Vector3d kCircle_m(0.03, 0.02, 0.02);

/// A box with a cylinder on it (`BoxScene`) as a case, and a scene next to the controller.
class SceneAnnotatingTest : public AnnotationTest {
 protected:
  void SetUp() override {
    AnnotationTest::SetUp();
    auto value = std::make_shared<sessions::LoadedCase>();
    value->source = state_.currentCase()->source;
    value->source.parts.clear();  // of another mesh
    value->image.width = value->image.height = 64;
    value->image.pixels.assign(64 * 64, 90);
    value->scene = Box().scene();
    state_.setCase(value);
    view_.setAnnotation(controller_, snapper_);
    view_.resize(700, 620);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    view_.refresh();
    ASSERT_TRUE(wait([this] { return snapper_.mesh() != nullptr; }));
    QTest::qWait(0);
  }

  /// Pixel of the canvas at which a place is drawn.
  QPointF pixelOf(const Vector3d& place_m) const {
    return view_.viewpoint().toCanvas(place_m).value();
  }
  QPointF corner(const QPointF& pixel) const {
    return test::cornerOfScreenPixel(*view_.canvas(), pixel + QPointF(0.5, 0.5));
  }
  /// Centre of the screen pixel of a pixel of the canvas: what the operator points at.
  QPointF pointedAt(const QPointF& pixel) const {
    const double half = 0.5 / view_.canvas()->devicePixelRatioF();
    return corner(pixel) + QPointF(half, half) - QPointF(0.5, 0.5);
  }
  void hover(const QPointF& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    test::moveMouse(*view_.canvas(), corner(pixel), modifiers);
  }
  void click(const QPointF& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    hover(pixel, modifiers);
    test::dragMouse(*view_.canvas(), {corner(pixel)}, Qt::LeftButton, modifiers);
  }
  void press(Qt::Key key) { QTest::keyClick(view_.canvas(), key); }
  QString aimText() const {
    return view_.annotator()->aim() ? view_.annotator()->aim()->text : QString();
  }
  Vector3d lastPlace_m() const {
    const auto& points = annotations().points;
    if (points.empty() || !points.back().point_in_station_m) return {9.0, 9.0, 9.0};
    return *points.back().point_in_station_m;
  }

  StationSnapper snapper_{state_};
  SceneView view_{state_, nullptr, SceneBackend::kPicture};
};

TEST_F(SceneAnnotatingTest, AClickTakesTheCornerEdgeOrCircleNearby_NotWhatIsHidden) {
  for (const StandardView view : {StandardView::kOblique, StandardView::kTop}) {
    SCOPED_TRACE(static_cast<int>(view));
    controller_.setAnnotations({}, QStringLiteral("Clear"));
    controller_.setMode(PlaceMode::kOff);
    view_.navigation().lookFrom(view);
    controller_.setMode(PlaceMode::kPoint);
    for (const QPointF& off : {QPointF(0, 0), QPointF(4, -3), QPointF(-5, 2)}) {
      controller_.select({});
      hover(pixelOf(kCorner_m) + off);
      EXPECT_EQ(aimText(), QStringLiteral("corner"));
      click(pixelOf(kCorner_m) + off);
      EXPECT_EQ(lastPlace_m(), kCorner_m) << "the vertex's own digits";
    }
    EXPECT_EQ(annotations().points.size(), 3u);

    const QPointF at_edge = pixelOf(0.6 * kCorner_m + 0.4 * kNextCorner_m) + QPointF(3.0, 3.0);
    click(at_edge);
    const Vector3d got_m = lastPlace_m();
    const Vector3d along = (kNextCorner_m - kCorner_m).normalized();
    EXPECT_LT((got_m - kCorner_m).cross(along).norm(), 1e-12) << "it lies on the edge";
    // A straight edge is seen straight: the foot of the perpendicular.
    const QPointF way = pixelOf(kNextCorner_m) - pixelOf(kCorner_m);
    const QPointF off = pixelOf(got_m) - pointedAt(at_edge);
    EXPECT_NEAR(QPointF::dotProduct(off, way) / std::hypot(way.x(), way.y()), 0.0, 1e-4);

    hover(pixelOf(kCircle_m) + QPointF(3.0, 2.0));
    EXPECT_EQ(aimText(), QStringLiteral("circle centre, radius 30.0 mm, z %1 mm")
                             .arg(1e3 * kCircle_m.z(), 0, 'f', 2));
    click(pixelOf(kCircle_m) + QPointF(3.0, 2.0));
    EXPECT_LT((lastPlace_m() - kCircle_m).norm(), 1e-8);

    click(pixelOf(kHiddenCorner_m));
    EXPECT_GT((lastPlace_m() - kHiddenCorner_m).norm(), 1e-3);

    const QPointF at = pixelOf(kCorner_m + Vector3d(-0.004, 0.004, 0.0));
    hover(at);
    EXPECT_EQ(aimText(), QStringLiteral("corner"));
    hover(at, Qt::AltModifier);
    EXPECT_EQ(aimText(), QStringLiteral("surface"));
    click(at, Qt::AltModifier);
    const Vector3d eye_m = view_.viewpoint().eyeInStation_m();
    const Vector3d ray = view_.viewpoint().rayInStation(pointedAt(at));
    EXPECT_LT((lastPlace_m() - (eye_m - eye_m.z() / ray.z() * ray)).norm(), 1e-7) << "at z = 0";

    controller_.setMode(PlaceMode::kLine);
    const QPointF at_line = pixelOf({0.1, 0.03, 0.0}) + QPointF(4.0, 2.0);
    hover(at_line);
    ASSERT_TRUE(view_.annotator()->aim());
    EXPECT_TRUE(view_.annotator()->aim()->edge);
    click(at_line);
    ASSERT_EQ(annotations().lines.size(), 1u);
    const sessions::ModelEdge edge = *annotations().lines[0].edge;
    const std::vector<Vector3d> ends_m = {edge.start_in_station_m, edge.end_in_station_m};
    EXPECT_THAT(ends_m, testing::UnorderedElementsAre(kCorner_m, kNextCorner_m));
  }
}

TEST_F(SceneAnnotatingTest, WithoutAnEdgeALineIsRefusedWithAReason_ADragTurnsTheViewOnly) {
  controller_.setMode(PlaceMode::kLine);
  QSignalSpy told(&controller_, &AnnotationController::told);
  click(pixelOf({-0.05, -0.03, 0.0}));
  ASSERT_EQ(told.count(), 1);
  EXPECT_TRUE(test::has(told[0][0].toString(), "edge"));
  controller_.setMode(PlaceMode::kPoint);
  click({3.0, 3.0});  // off the station
  EXPECT_EQ(told.count(), 2);
  const double azimuth_rad = view_.navigation().orbit().azimuth_rad();
  const QPointF from = corner(pixelOf(kCorner_m));
  const QPointF step = QPointF(20.0, 0.0) / view_.canvas()->devicePixelRatioF();
  test::dragMouse(*view_.canvas(),
                  {from, from + step, from + 2 * step, from + 3 * step, from + 4 * step});
  EXPECT_NE(view_.navigation().orbit().azimuth_rad(), azimuth_rad);
  EXPECT_TRUE(annotations().empty());
}

TEST_F(SceneAnnotatingTest, TabCyclesThroughSnapTargets_EscapeDropsTheChoiceThenTheMode) {
  controller_.setMode(PlaceMode::kPoint);
  hover(pixelOf(kCorner_m) + QPointF(2.0, 1.0));
  ASSERT_EQ(aimText(), QStringLiteral("corner"));
  QEvent enter(QEvent::Enter);
  QApplication::sendEvent(view_.canvas(), &enter);
  ASSERT_EQ(QApplication::focusWidget(), view_.canvas()) << "the keys are for it";
  press(Qt::Key_Tab);
  EXPECT_EQ(aimText(), QStringLiteral("edge"));
  EXPECT_EQ(QApplication::focusWidget(), view_.canvas()) << "Tab has not moved the focus";
  press(Qt::Key_Tab);
  EXPECT_EQ(aimText(), QStringLiteral("corner"));
  press(Qt::Key_Tab);
  click(pixelOf(kCorner_m) + QPointF(2.0, 1.0));
  EXPECT_NE(lastPlace_m(), kCorner_m) << "what is shown is what is marked";
  ASSERT_FALSE(controller_.selected().empty());
  press(Qt::Key_Escape);
  EXPECT_TRUE(controller_.selected().empty());
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  press(Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
}

/// A comment was cut off where the pointer drifted over the scene, and Del removed an annotation.
TEST_F(SceneAnnotatingTest, PointerOverTheScene_LeavesAFieldThatIsTypedInto_TabLeadsOn) {
  controller_.setMode(PlaceMode::kPoint);
  QLineEdit field(&view_);
  field.show();
  field.setFocus();
  QEvent enter(QEvent::Enter);
  QApplication::sendEvent(view_.canvas(), &enter);
  EXPECT_TRUE(field.hasFocus());
  view_.canvas()->setFocus();
  hover({3.0, 3.0});  // off the station: nothing else to take
  press(Qt::Key_Tab);
  EXPECT_NE(QApplication::focusWidget(), view_.canvas());
}

TEST_F(SceneAnnotatingTest, AClickCompletesThePairThatWasBegunInTheImage) {
  controller_.setMode(PlaceMode::kPoint);
  const std::string begun = controller_.placeInImage({10.0, 12.0});
  EXPECT_TRUE(test::has(view_.annotator()->nextStep(), "p1"));
  click(pixelOf(kCorner_m));
  ASSERT_EQ(annotations().points.size(), 1u);
  EXPECT_EQ(annotations().points[0].id, begun);
  EXPECT_TRUE(annotations().points[0].complete());
}

TEST_F(SceneAnnotatingTest, ClickOnAnAnnotation_OutsidePlacingMode_SelectsIt) {
  std::vector<std::string> ids;
  for (const Vector3d& place_m : {kCorner_m, kHiddenCorner_m}) {
    ids.push_back(controller_.placeOnStation(place_m));
    controller_.select({});
  }
  const std::string edge =
      controller_.placeEdgeOnStation({{-0.1, -0.1, 0.0}, kCorner_m});  // the front one
  controller_.select({});
  QTest::qWait(0);
  click(pixelOf(kCorner_m) + QPointF(0.0, -3.0));
  EXPECT_EQ(controller_.selected(), ids[0]);
  click(pixelOf({-0.04, -0.1, 0.0}));
  EXPECT_EQ(controller_.selected(), edge);
  click(pixelOf(kHiddenCorner_m));
  EXPECT_NE(controller_.selected(), ids[1]) << "a face hides it";
  EXPECT_EQ(annotations().points.size(), 2u);
  controller_.setMode(PlaceMode::kPoint);
  controller_.select({});
  click(pixelOf(kCorner_m));
  EXPECT_EQ(annotations().points.size(), 3u);
}

TEST_F(SceneAnnotatingTest, AnnotationMode_EnlargesTheStationUntilTheViewIsTurned) {
  const auto distance_m = [this] { return view_.navigation().orbit().distance_m(); };
  const double all_m = distance_m();
  controller_.setMode(PlaceMode::kPoint);
  EXPECT_LT(distance_m(), all_m) << "without the cameras";
  controller_.setMode(PlaceMode::kOff);
  EXPECT_EQ(distance_m(), all_m);
  press(Qt::Key_Left);
  controller_.setMode(PlaceMode::kPoint);
  EXPECT_EQ(distance_m(), all_m) << "the operator chose this distance";
  hover(pixelOf(kCorner_m));
  EXPECT_TRUE(test::has(view_.findChild<QLabel*>(QStringLiteral("sceneReadout"))->text(),
                        "x 100.00, y -100.00, z 0.00 mm"));
}

TEST_F(SceneAnnotatingTest, Loupe_InPlacingMode_ShowsTheMagnifiedPoint) {
  SceneLoupe& loupe = view_.annotator()->loupe();
  hover(pixelOf(kCorner_m));
  EXPECT_FALSE(loupe.isVisible()) << "placing mode is off";
  controller_.setMode(PlaceMode::kPoint);
  hover(pixelOf(kCorner_m));
  ASSERT_TRUE(loupe.isVisible());
  EXPECT_FALSE(loupe.geometry().contains(pixelOf(kCorner_m).toPoint()));
  ASSERT_TRUE(wait([&] { return loupe.ready(); }));
  const double distance_m = view_.navigation().orbit().distance_m();
  test::turnWheel(*view_.canvas(), pixelOf(kCorner_m), 9, Qt::ControlModifier);
  EXPECT_DOUBLE_EQ(loupe.magnification(), SceneLoupe::kMostMagnification);
  EXPECT_EQ(view_.navigation().orbit().distance_m(), distance_m) << "the scene itself stays";
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(view_.canvas(), &leave);
  EXPECT_FALSE(loupe.isVisible());

  const QPointF pointer(201.3, 155.8);
  for (const double magnification : {4.0, 16.0})
    for (const Vector3d& place_m : {kCorner_m, kCircle_m, kHiddenCorner_m}) {
      const Viewpoint magnified = magnifiedView(view_.viewpoint(), pointer, magnification, 160);
      const QPointF expected = magnification * (pixelOf(place_m) - pointer) + QPointF(79.5, 79.5);
      EXPECT_NEAR(magnified.toCanvas(place_m).value().x(), expected.x(), 1e-9);
      EXPECT_NEAR(magnified.toCanvas(place_m).value().y(), expected.y(), 1e-9);
    }
}

/// Two cases of one rig: the other camera stands where the rig puts it.
class SceneOfARigTest : public AnnotationTest {};

TEST_F(SceneOfARigTest, ShowsTheOtherCamerasWhereTheSolvedRigPutsThem) {
  const std::string own = source().id;
  const std::string other = document_.session().cases.back()->id;
  const Pose other_from_own{rotationExp({0.0, 0.1, 0.0}), {0.2, 0.0, 0.0}};
  const Pose other_from_station = other_from_own * truth();
  sessions::Session session =
      sessions::withRigLink(document_.session(), own, other, other_from_own);
  sessions::PointPair point;  // of the other camera: one place, exactly where it is seen
  point.id = "p1";
  point.point_in_station_m = corners_m(1).front();
  point.pixel.emplace();
  ASSERT_TRUE(project(session.findCase(other)->camera,
                      other_from_station * *point.point_in_station_m, *point.pixel));
  session = sessions::withAnnotations(session, other, {{point}, {}});
  ASSERT_TRUE(document_.edit(session, QStringLiteral("Rig")));
  open(own);
  solveCorners(8);
  StationSnapper snapper(state_);
  SceneView view(state_, nullptr, SceneBackend::kPicture);
  view.setAnnotation(controller_, snapper);
  view.refresh();
  int shown = 0;
  for (const Frustum& frustum : view.content().frusta) {
    if (frustum.label != QString::fromStdString(other)) continue;
    ++shown;
    EXPECT_LT((frustum.apex_m - other_from_station.inverse().translation_m).norm(), 1e-5);
  }
  EXPECT_EQ(shown, 1);
}

TEST_F(SceneAnnotatingTest, Annotations_AreDrawnByTheirState) {
  std::vector<QImage> pictures;
  const auto draw = [&] { pictures.push_back(view_.grab().toImage()); };
  draw();
  const std::string id = controller_.placeOnStation(kCorner_m);
  draw();  // half made and chosen
  controller_.select({});
  draw();
  controller_.select(id);
  controller_.placeInImage({20.0, 20.0});
  controller_.select({});
  draw();  // complete
  for (const bool lock : {true, false}) {
    sessions::PointPair point = annotations().points[0];
    point.locked = point.enabled = lock;
    ASSERT_TRUE(controller_.replacePoint(id, point, QStringLiteral("Change")));
    draw();  // locked, then off
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const auto differ = [&](int x, int y) {
        return pictures[i].pixel(x, y) != pictures[k].pixel(x, y);
      };
      EXPECT_GT(test::countPixels(pictures[i].size(), differ), 20) << i << " looks like " << k;
    }
}

}  // namespace
}  // namespace boresight::ui
