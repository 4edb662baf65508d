// SPDX-License-Identifier: Apache-2.0
// Annotations placed with real mouse events in the scene, without OpenGL. Runs at a scaling of 1,
// and again with QT_SCALE_FACTOR=1.5.
#include <gtest/gtest.h>

#include <cmath>

#include <QtWidgets>

#include "tests/sessions/annotation/box_scene.h"
#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/station_snapper.h"
#include "ui/scene/scene_annotator.h"
#include "ui/scene/scene_view.h"

namespace boresight::ui {
namespace {

struct Box : test::BoxScene {
  const sessions::SceneMesh& scene() const { return scene_; }
};

const Eigen::Vector3d kCorner_m = Eigen::Vector3f(0.1F, -0.1F, 0.0F).cast<double>();
const Eigen::Vector3d kHiddenCorner_m = Eigen::Vector3f(-0.1F, 0.1F, -0.04F).cast<double>();
const Eigen::Vector3d kCircle_m(0.03, 0.02, 0.02);

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
    ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, kPatience_ms));
    QTest::qWait(0);
  }

  double ratio() const { return view_.canvas()->devicePixelRatioF(); }
  /// Pixel of the canvas at which a place is drawn.
  QPointF pixelOf(const Eigen::Vector3d& place_m) const {
    return view_.viewpoint().toCanvas(place_m).value();
  }
  /// The screen pixel that a pixel of the canvas lies on.
  QPoint screenPixel(const QPointF& pixel) const {
    const QPointF at = ratio() * (pixel + QPointF(0.5, 0.5));
    return {static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))};
  }
  /// Pixel of the canvas at that screen pixel's centre: what the operator points at.
  QPointF pointedAt(const QPoint& screen_pixel) const {
    return (QPointF(screen_pixel) + QPointF(0.5, 0.5)) / ratio() - QPointF(0.5, 0.5);
  }
  void send(QEvent::Type type, const QPoint& screen_pixel, Qt::MouseButton button,
            Qt::MouseButtons held, Qt::KeyboardModifiers modifiers) {
    const QPointF at = QPointF(screen_pixel) / ratio();
    const QPointF global = QPointF(view_.canvas()->mapToGlobal(QPoint(0, 0))) + at;
    QMouseEvent event(type, at, global, button, held, modifiers);
    QApplication::sendEvent(view_.canvas(), &event);
  }
  void hover(const QPointF& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    send(QEvent::MouseMove, screenPixel(pixel), Qt::NoButton, Qt::NoButton, modifiers);
  }
  void click(const QPointF& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    hover(pixel, modifiers);
    send(QEvent::MouseButtonPress, screenPixel(pixel), Qt::LeftButton, Qt::LeftButton, modifiers);
    send(QEvent::MouseButtonRelease, screenPixel(pixel), Qt::LeftButton, Qt::NoButton, modifiers);
  }
  QString aimText() const {
    return view_.annotator()->aim() ? view_.annotator()->aim()->text : QString();
  }
  Eigen::Vector3d lastPlace_m() const {
    const auto& points = controller_.annotations().points;
    if (points.empty() || !points.back().point_in_station_m) return {9.0, 9.0, 9.0};
    return *points.back().point_in_station_m;
  }
  /// Where the ray through what is pointed at meets a level plane.
  Eigen::Vector3d onLevel(const QPointF& pixel, double z_m) const {
    const Viewpoint view = view_.viewpoint();
    const Eigen::Vector3d eye = view.eyeInStation_m();
    const Eigen::Vector3d ray = view.rayInStation(pointedAt(screenPixel(pixel)));
    return eye + (z_m - eye.z()) / ray.z() * ray;
  }

  StationSnapper snapper_{state_};
  SceneView view_{state_, nullptr, SceneBackend::kPicture};
};

class SceneAnnotatingFrom : public SceneAnnotatingTest,
                            public ::testing::WithParamInterface<StandardView> {
 protected:
  void SetUp() override {
    SceneAnnotatingTest::SetUp();
    view_.navigation().lookFrom(GetParam());
    controller_.setMode(PlaceMode::kPoint);
  }
};

TEST_P(SceneAnnotatingFrom, AClickNearACornerGivesTheVerticesOwnDigits) {
  for (const QPointF& off : {QPointF(0, 0), QPointF(4, -3), QPointF(-5, 2)}) {
    controller_.select({});
    hover(pixelOf(kCorner_m) + off);
    EXPECT_EQ(aimText(), QStringLiteral("corner"));
    click(pixelOf(kCorner_m) + off);
    EXPECT_EQ(lastPlace_m(), kCorner_m);
  }
  EXPECT_EQ(controller_.annotations().points.size(), 3u);
}

TEST_P(SceneAnnotatingFrom, AClickNearAnEdgeGivesItsNearestPlace) {
  const Eigen::Vector3d start_m = kCorner_m;
  const Eigen::Vector3d end_m = Eigen::Vector3f(0.1F, 0.1F, 0.0F).cast<double>();
  const QPointF on_edge = pixelOf(0.6 * start_m + 0.4 * end_m);
  const QPointF at = on_edge + QPointF(3.0, 3.0);
  click(at);
  const Eigen::Vector3d got_m = lastPlace_m();
  const Eigen::Vector3d along = (end_m - start_m).normalized();
  EXPECT_LT((got_m - start_m).cross(along).norm(), 1e-12) << "it lies on the edge";
  // A straight edge is seen straight: the foot of the perpendicular.
  const QPointF pointed = pointedAt(screenPixel(at));
  const QPointF way = pixelOf(end_m) - pixelOf(start_m);
  const QPointF off = pixelOf(got_m) - pointed;
  EXPECT_NEAR(QPointF::dotProduct(off, way) / std::hypot(way.x(), way.y()), 0.0, 1e-4);
}

TEST_P(SceneAnnotatingFrom, AClickNearTheMiddleOfACircleGivesItsCentre) {
  hover(pixelOf(kCircle_m) + QPointF(3.0, 2.0));
  EXPECT_EQ(
      aimText(),
      QStringLiteral("circle centre, radius 30.0 mm, z %1 mm").arg(1e3 * kCircle_m.z(), 0, 'f', 2));
  click(pixelOf(kCircle_m) + QPointF(3.0, 2.0));
  EXPECT_LT((lastPlace_m() - kCircle_m).norm(), 1e-8);
}

TEST_P(SceneAnnotatingFrom, WhatAFaceHidesIsNotTaken) {
  click(pixelOf(kHiddenCorner_m));
  EXPECT_GT((lastPlace_m() - kHiddenCorner_m).norm(), 1e-3);
}

TEST_P(SceneAnnotatingFrom, AltTakesTheSurfaceInstead) {
  const QPointF at = pixelOf(kCorner_m + Eigen::Vector3d(-0.004, 0.004, 0.0));
  hover(at);
  EXPECT_EQ(aimText(), QStringLiteral("corner"));
  hover(at, Qt::AltModifier);
  EXPECT_EQ(aimText(), QStringLiteral("surface"));
  click(at, Qt::AltModifier);
  EXPECT_LT((lastPlace_m() - onLevel(at, 0.0)).norm(), 1e-7);
}

TEST_P(SceneAnnotatingFrom, AnEdgeIsAnnotatedInLineMode) {
  controller_.setMode(PlaceMode::kLine);
  const Eigen::Vector3d middle_m(0.1, 0.03, 0.0);
  hover(pixelOf(middle_m) + QPointF(4.0, 2.0));
  ASSERT_TRUE(view_.annotator()->aim());
  EXPECT_TRUE(view_.annotator()->aim()->edge);
  click(pixelOf(middle_m) + QPointF(4.0, 2.0));
  ASSERT_EQ(controller_.annotations().lines.size(), 1u);
  const sessions::ModelEdge edge = *controller_.annotations().lines[0].edge;
  for (const Eigen::Vector3d& end_m : {edge.start_in_station_m, edge.end_in_station_m}) {
    EXPECT_EQ(end_m.x(), kCorner_m.x());
    EXPECT_EQ(std::abs(end_m.y()), std::abs(kCorner_m.y()));
    EXPECT_EQ(end_m.z(), 0.0);
  }
  EXPECT_NE(edge.start_in_station_m, edge.end_in_station_m);
}

INSTANTIATE_TEST_SUITE_P(Views, SceneAnnotatingFrom,
                         ::testing::Values(StandardView::kOblique, StandardView::kTop));

TEST_F(SceneAnnotatingTest, WithoutAnEdgeALineIsRefusedWithAReason) {
  controller_.setMode(PlaceMode::kLine);
  QSignalSpy told(&controller_, &AnnotationController::told);
  click(pixelOf({-0.05, -0.03, 0.0}));
  EXPECT_TRUE(controller_.annotations().lines.empty());
  ASSERT_EQ(told.count(), 1);
  EXPECT_TRUE(told[0][0].toString().contains(QStringLiteral("edge")));
  controller_.setMode(PlaceMode::kPoint);
  click({3.0, 3.0});  // off the station
  EXPECT_EQ(told.count(), 2);
  EXPECT_TRUE(controller_.annotations().empty());
}

TEST_F(SceneAnnotatingTest, Tab_CyclesThroughSnapTargets) {
  controller_.setMode(PlaceMode::kPoint);
  hover(pixelOf(kCorner_m) + QPointF(2.0, 1.0));
  ASSERT_EQ(aimText(), QStringLiteral("corner"));
  QEvent enter(QEvent::Enter);
  QApplication::sendEvent(view_.canvas(), &enter);
  ASSERT_EQ(QApplication::focusWidget(), view_.canvas()) << "the keys are for it";
  QTest::keyClick(view_.canvas(), Qt::Key_Tab);
  EXPECT_EQ(aimText(), QStringLiteral("edge"));
  EXPECT_EQ(QApplication::focusWidget(), view_.canvas()) << "Tab has not moved the focus";
  QTest::keyClick(view_.canvas(), Qt::Key_Tab);
  EXPECT_EQ(aimText(), QStringLiteral("corner"));
  QTest::keyClick(view_.canvas(), Qt::Key_Tab);
  click(pixelOf(kCorner_m) + QPointF(2.0, 1.0));
  EXPECT_NE(lastPlace_m(), kCorner_m) << "what is shown is what is marked";
}

TEST_F(SceneAnnotatingTest, APairIsCompletedFromTheSceneInEitherOrder) {
  controller_.setMode(PlaceMode::kPoint);
  const std::string image_first = controller_.placeInImage({10.0, 12.0});
  EXPECT_TRUE(view_.annotator()->nextStep().contains(QStringLiteral("p1")));
  click(pixelOf(kCorner_m));
  ASSERT_EQ(controller_.annotations().points.size(), 1u);
  EXPECT_EQ(controller_.annotations().points[0].id, image_first);
  EXPECT_TRUE(controller_.annotations().points[0].complete());
  click(pixelOf(kCircle_m));
  ASSERT_EQ(controller_.annotations().points.size(), 2u);
  EXPECT_FALSE(controller_.annotations().points[1].complete());
  const std::string scene_first = controller_.annotations().points[1].id;
  EXPECT_EQ(controller_.placeInImage({20.0, 22.0}), scene_first);
  EXPECT_TRUE(controller_.annotations().points[1].complete());
  ASSERT_TRUE(document_.undo());
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(controller_.annotations().points.size(), 1u);
}

TEST_F(SceneAnnotatingTest, ClickOnAnAnnotation_OutsidePlacingMode_SelectsIt) {
  const std::string corner = controller_.placeOnStation(kCorner_m);
  controller_.select({});
  const std::string hidden = controller_.placeOnStation(kHiddenCorner_m);
  controller_.select({});
  const std::string edge =
      controller_.placeEdgeOnStation({{-0.1, -0.1, 0.0}, kCorner_m});  // the front one
  controller_.select({});
  QTest::qWait(0);
  click(pixelOf(kCorner_m) + QPointF(0.0, -3.0));
  EXPECT_EQ(controller_.selected(), corner);
  click(pixelOf({-0.04, -0.1, 0.0}));
  EXPECT_EQ(controller_.selected(), edge);
  click(pixelOf(kHiddenCorner_m));
  EXPECT_NE(controller_.selected(), hidden) << "a face hides it";
  const std::size_t before = controller_.annotations().points.size();
  controller_.setMode(PlaceMode::kPoint);
  controller_.select({});
  click(pixelOf(kCorner_m));
  EXPECT_EQ(controller_.annotations().points.size(), before + 1);
}

TEST_F(SceneAnnotatingTest, EscapeDropsTheChoiceThenTheMode) {
  controller_.setMode(PlaceMode::kPoint);
  click(pixelOf(kCorner_m));
  ASSERT_FALSE(controller_.selected().empty());
  QTest::keyClick(view_.canvas(), Qt::Key_Escape);
  EXPECT_TRUE(controller_.selected().empty());
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  QTest::keyClick(view_.canvas(), Qt::Key_Escape);
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
}

TEST_F(SceneAnnotatingTest, Drag_TurnsTheViewOnly) {
  controller_.setMode(PlaceMode::kPoint);
  const double azimuth_rad = view_.navigation().orbit().azimuth_rad();
  const QPoint from = screenPixel(pixelOf(kCorner_m));
  send(QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
  for (int i = 1; i <= 4; ++i)
    send(QEvent::MouseMove, from + QPoint(20 * i, 0), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  send(QEvent::MouseButtonRelease, from + QPoint(80, 0), Qt::LeftButton, Qt::NoButton,
       Qt::NoModifier);
  EXPECT_NE(view_.navigation().orbit().azimuth_rad(), azimuth_rad);
  EXPECT_TRUE(controller_.annotations().empty());
}

TEST_F(SceneAnnotatingTest, AnnotationMode_EnlargesTheStationUntilTheViewIsTurned) {
  const double all_m = view_.navigation().orbit().distance_m();
  controller_.setMode(PlaceMode::kPoint);
  EXPECT_LT(view_.navigation().orbit().distance_m(), all_m) << "without the cameras";
  controller_.setMode(PlaceMode::kOff);
  EXPECT_EQ(view_.navigation().orbit().distance_m(), all_m);
  QTest::keyClick(view_.canvas(), Qt::Key_Left);
  controller_.setMode(PlaceMode::kPoint);
  EXPECT_EQ(view_.navigation().orbit().distance_m(), all_m) << "the operator chose this distance";
  hover(pixelOf(kCorner_m));
  const QString figures = view_.findChild<QLabel*>(QStringLiteral("sceneReadout"))->text();
  EXPECT_TRUE(figures.contains(QStringLiteral("x 100.00, y -100.00, z 0.00 mm")))
      << figures.toStdString();
}

TEST_F(SceneAnnotatingTest, Loupe_InPlacingMode_ShowsTheMagnifiedPoint) {
  SceneLoupe& loupe = view_.annotator()->loupe();
  hover(pixelOf(kCorner_m));
  EXPECT_FALSE(loupe.isVisible()) << "placing mode is off";
  controller_.setMode(PlaceMode::kPoint);
  hover(pixelOf(kCorner_m));
  ASSERT_TRUE(loupe.isVisible());
  EXPECT_FALSE(loupe.geometry().contains(pixelOf(kCorner_m).toPoint()));
  ASSERT_TRUE(QTest::qWaitFor([&] { return loupe.ready(); }, kPatience_ms));
  const QWheelEvent more(pixelOf(kCorner_m), view_.mapToGlobal(QPoint()), {}, {0, 120 * 9},
                         Qt::NoButton, Qt::ControlModifier, Qt::NoScrollPhase, false);
  const double distance_m = view_.navigation().orbit().distance_m();
  QWheelEvent turned = more;
  QApplication::sendEvent(view_.canvas(), &turned);
  EXPECT_DOUBLE_EQ(loupe.magnification(), SceneLoupe::kMostMagnification);
  EXPECT_EQ(view_.navigation().orbit().distance_m(), distance_m) << "the scene itself stays";
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(view_.canvas(), &leave);
  EXPECT_FALSE(loupe.isVisible());
}

TEST_F(SceneAnnotatingTest, TheLoupesPictureIsTheGeometryMagnifiedAboutThePointer) {
  const Viewpoint view = view_.viewpoint();
  const QPointF pointer(201.3, 155.8);
  for (const double magnification : {4.0, 16.0}) {
    const Viewpoint loupe = magnifiedView(view, pointer, magnification, 160);
    for (const Eigen::Vector3d& place_m : {kCorner_m, kCircle_m, kHiddenCorner_m}) {
      const QPointF at = loupe.toCanvas(place_m).value();
      const QPointF expected = magnification * (pixelOf(place_m) - pointer) + QPointF(79.5, 79.5);
      EXPECT_NEAR(at.x(), expected.x(), 1e-9);
      EXPECT_NEAR(at.y(), expected.y(), 1e-9);
    }
  }
}

/// Two cases of one rig: the other camera stands where the rig puts it.
class SceneOfARigTest : public AnnotationTest {};

TEST_F(SceneOfARigTest, ShowsTheOtherCamerasWhereTheSolvedRigPutsThem) {
  const std::string own = source().id;
  sessions::Session session = document_.session();
  Pose other_from_own;
  other_from_own.rotation = rotationExp({0.0, 0.1, 0.0});
  other_from_own.translation_m = {0.2, 0.0, 0.0};
  const std::string other = session.cases.back()->id;
  ASSERT_NE(own, other);
  for (const std::string& id : {own, other}) {
    sessions::SessionCase session_case = *session.findCase(id);
    session_case.rig = sessions::Rig{"rig", id == own ? Pose() : other_from_own};
    session = withCase(session, session_case);
  }
  sessions::Annotations annotations;  // of the other camera: one place, exactly where it is seen
  sessions::PointPair point;
  point.id = "p1";
  point.point_in_station_m = corners_m(1).front();
  Eigen::Vector2d pixel;
  const Pose other_from_station = other_from_own * truth();
  ASSERT_TRUE(project(session.findCase(other)->camera,
                      other_from_station * *point.point_in_station_m, pixel));
  point.pixel = pixel;
  annotations.points = {point};
  session = sessions::withAnnotations(session, other, annotations);
  ASSERT_TRUE(document_.edit(session, QStringLiteral("Rig")));
  open(own);
  ASSERT_EQ(markCorners(8).size(), 8u);
  ASSERT_TRUE(solved());
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
  const auto drawn = [this] { return view_.grab().toImage(); };
  const auto differing = [](const QImage& a, const QImage& b) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x) count += a.pixel(x, y) != b.pixel(x, y);
    return count;
  };
  std::vector<QImage> pictures = {drawn()};
  const std::string id = controller_.placeOnStation(kCorner_m);
  pictures.push_back(drawn());  // half made and chosen
  controller_.select({});
  pictures.push_back(drawn());
  controller_.select(id);
  controller_.placeInImage({20.0, 20.0});
  controller_.select({});
  pictures.push_back(drawn());  // complete
  for (const bool lock : {true, false}) {
    sessions::PointPair point = controller_.annotations().points[0];
    point.locked = lock;
    point.enabled = lock;
    ASSERT_TRUE(controller_.replacePoint(id, point, QStringLiteral("Change")));
    pictures.push_back(drawn());  // locked, then off
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GT(differing(pictures[i], pictures[k]), 20) << i << " looks like " << k;
}

}  // namespace
}  // namespace boresight::ui
