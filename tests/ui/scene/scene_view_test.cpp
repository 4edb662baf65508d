// SPDX-License-Identifier: Apache-2.0
// Offscreen: the picture stands in for VTK, mouse and keys are real events.
#include "ui/scene/scene_view.h"

#include <gtest/gtest.h>
#include <QTest>
#include <QtWidgets>

#include "sessions/trace/surface_point.h"
#include "tests/ui/scene/scene_fixture.h"
#include "ui/scene/scene_canvas.h"

namespace boresight::ui {
namespace {

class SceneViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    test::showRun(state_);
    view_.resize(640, 520);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    view_.refresh();
  }

  /// The canvas' pixel under the pointer after a click there; centres are at whole numbers.
  QPoint onCanvas(const Eigen::Vector3d& at_m) const {
    return view_.viewpoint().toCanvas(at_m).value().toPoint();
  }
  void click(const QPoint& at) {
    QTest::mouseClick(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  }
  void drag(const QPoint& from, const QPoint& to, Qt::MouseButton button,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::mousePress(view_.canvas(), button, modifiers, from);
    // QTest::mouseMove tells nothing of buttons.
    for (int i = 1; i <= 4; ++i) {
      const QPoint at = from + (to - from) * i / 4;
      QMouseEvent move(QEvent::MouseMove, at, view_.canvas()->mapToGlobal(at), Qt::NoButton, button,
                       modifiers);
      QApplication::sendEvent(view_.canvas(), &move);
    }
    QTest::mouseRelease(view_.canvas(), button, modifiers, to);
  }
  void wheel(const QPoint& at, int notches) {
    QWheelEvent event(at, view_.canvas()->mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton,
                      Qt::NoModifier, Qt::NoScrollPhase, false);
    QApplication::sendEvent(view_.canvas(), &event);
  }

  QString readout() const {
    return view_.findChild<QLabel*>(QStringLiteral("sceneReadout"))->text();
  }

  ViewState state_;
  SceneView view_{state_, nullptr, SceneBackend::kPicture};
};

TEST_F(SceneViewTest, AClickSelectsTheTemplateUnderIt) {
  view_.navigation().setThroughCamera(true);  // from where the templates are seen
  int tried = 0;
  for (const ScenePoint& point : view_.content().points) {
    const int expected = pickTemplate(view_.content(), view_.viewpoint(), onCanvas(point.at_m));
    if (expected < 0 || ++tried > 10) continue;
    state_.selectTemplate(-1);
    click(onCanvas(point.at_m));
    EXPECT_EQ(state_.selectedTemplate(), expected);
  }
  EXPECT_GT(tried, 3);
  view_.refresh();
  EXPECT_EQ(view_.content().selected_template, state_.selectedTemplate());
}

TEST_F(SceneViewTest, AClickOnTheMeshTellsItsPlaceInTheStation) {
  view_.setShown({.points = false});
  const QPoint at = onCanvas(view_.content().bounds.centre());
  const Viewpoint view = view_.viewpoint();
  const auto expected =
      sessions::surfacePointAt(view.camera, view_.content().mesh(), view.view_from_station,
                               {static_cast<double>(at.x()), static_cast<double>(at.y())});
  ASSERT_TRUE(expected);
  click(at);
  EXPECT_EQ(readout(), stationPlaceText(expected->in_station_m, QStringLiteral("surface")));
  click({3, 3});
  EXPECT_TRUE(readout().startsWith(QStringLiteral("No object")));
}

TEST_F(SceneViewTest, Readout_OfAnotherCaseIsNotKept) {
  click(onCanvas(view_.content().bounds.centre()));
  const QString picked = readout();
  state_.setCase(test::loadedExample("bc"));
  view_.refresh();
  EXPECT_NE(readout(), picked);
}

TEST_F(SceneViewTest, HoveringTellsThePlaceOfTheStation) {
  std::optional<Eigen::Vector3d> hovered;
  QObject::connect(&view_, &SceneView::stationPlaceHovered, &view_,
                   [&](const std::optional<Eigen::Vector3d>& place) { hovered = place; });
  const QPoint at = onCanvas(view_.content().bounds.centre());
  QMouseEvent move(QEvent::MouseMove, at, view_.canvas()->mapToGlobal(at), Qt::NoButton,
                   Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(view_.canvas(), &move);
  ASSERT_TRUE(hovered);
  EXPECT_LT((view_.viewpoint().toCanvas(*hovered).value() - QPointF(at)).manhattanLength(), 1.5);
}

TEST_F(SceneViewTest, ADoubleClickShowsTheWholeScene) {
  view_.setShown({.points = false});
  wheel({300, 240}, 2);
  const double near_m = view_.navigation().orbit().distance_m();
  const QPoint at = onCanvas(view_.content().bounds.centre());
  QTest::mouseDClick(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  const QString before = readout();
  QTest::mouseRelease(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  EXPECT_EQ(readout(), before) << "the second release is no click";
  EXPECT_GT(view_.navigation().orbit().distance_m(), near_m);
}

TEST_F(SceneViewTest, DraggingOrbitsAndPicksNothing) {
  const double azimuth_rad = view_.navigation().orbit().azimuth_rad();
  const int selected = state_.selectedTemplate();
  const QString before = readout();
  drag({300, 240}, {380, 240}, Qt::LeftButton);
  EXPECT_LT(view_.navigation().orbit().azimuth_rad(), azimuth_rad);
  EXPECT_EQ(state_.selectedTemplate(), selected);
  EXPECT_EQ(readout(), before);
}

TEST_F(SceneViewTest, TheMiddleButtonAndShiftPan) {
  for (const bool shift : {false, true}) {
    const Eigen::Vector3d target_m = view_.navigation().orbit().target_m();
    const double azimuth_rad = view_.navigation().orbit().azimuth_rad();
    drag({300, 240}, {340, 200}, shift ? Qt::LeftButton : Qt::MiddleButton,
         shift ? Qt::ShiftModifier : Qt::NoModifier);
    EXPECT_GT((view_.navigation().orbit().target_m() - target_m).norm(), 1e-4);
    EXPECT_EQ(view_.navigation().orbit().azimuth_rad(), azimuth_rad);
  }
}

TEST_F(SceneViewTest, TheWheelComesNearerAndHomeGoesBack) {
  const double distance_m = view_.navigation().orbit().distance_m();
  wheel({200, 200}, 2);
  EXPECT_LT(view_.navigation().orbit().distance_m(), distance_m);
  QTest::keyClick(view_.canvas(), Qt::Key_Home);
  EXPECT_EQ(view_.navigation().orbit().distance_m(), distance_m);
}

TEST_F(SceneViewTest, KeysLookFromFixedDirections) {
  QTest::keyClick(view_.canvas(), Qt::Key_1);
  EXPECT_NEAR(view_.navigation().orbit().elevation_rad(), std::acos(0.0), 1e-12);
  QTest::keyClick(view_.canvas(), Qt::Key_3);
  EXPECT_EQ(view_.navigation().orbit().elevation_rad(), 0.0);
  EXPECT_EQ(view_.navigation().orbit().azimuth_rad(), 0.0);
}

TEST_F(SceneViewTest, ThroughTheCameraTheWheelKeepsThePixelUnderTheMouse) {
  QTest::keyClick(view_.canvas(), Qt::Key_V);
  ASSERT_TRUE(view_.navigation().throughCamera());
  const QPoint mouse(200, 150);
  const QPointF before = view_.navigation().image().toPixel(mouse);
  wheel(mouse, 3);
  const QPointF after = view_.navigation().image().toPixel(mouse);
  EXPECT_NEAR(after.x(), before.x(), 1e-9);
  EXPECT_NEAR(after.y(), before.y(), 1e-9);
  QTest::keyClick(view_.canvas(), Qt::Key_V);
  EXPECT_FALSE(view_.navigation().throughCamera());
}

TEST_F(SceneViewTest, ThroughTheCameraTheMeshLiesWhereTheImageShowsIt) {
  view_.navigation().setThroughCamera(true);
  view_.setThroughRole(PoseRole::kTruth);
  const Viewpoint view = view_.viewpoint();
  EXPECT_EQ(view.view_from_station.translation_m,
            test::sceneCase()->source.camera_from_station_truth->translation_m);
  // Mirrors the camera's principal point, which is not the canvas' centre.
  const QPointF centre = view_.navigation().image().toWidget(
      QPointF(test::sceneCase()->source.camera.cx, test::sceneCase()->source.camera.cy));
  EXPECT_NEAR(view.camera.cx + 0.5, centre.x(), 1e-9);
  EXPECT_NEAR(view.camera.cy + 0.5, centre.y(), 1e-9);
}

TEST_F(SceneViewTest, ANewSnapshotLeavesTheViewAlone) {
  wheel({200, 200}, 3);
  const double distance_m = view_.navigation().orbit().distance_m();
  state_.setSnapshot(test::firstIterations(*test::exampleRun(), 1));
  view_.refresh();
  EXPECT_EQ(view_.navigation().orbit().distance_m(), distance_m);
}

TEST_F(SceneViewTest, FollowsTheStateWhileItIsShownAndCatchesUpAfterwards) {
  state_.setNudgedPose(state_.shownPose());
  ASSERT_TRUE(QTest::qWaitFor([&] { return view_.content().frusta.size() == 4; }, 5000));
  view_.hide();
  state_.setNudgedPose(std::nullopt);
  QTest::qWait(20);
  EXPECT_EQ(view_.content().frusta.size(), 4u);
  view_.show();
  EXPECT_EQ(view_.content().frusta.size(), 3u);
}

TEST_F(SceneViewTest, IsNotBlackAndSaysHowItIsDrawn) {
  const QImage picture = view_.grab().toImage();
  EXPECT_LT(test::pixelsLike(picture, Qt::black, 0), picture.width() * picture.height() / 20);
}

TEST(SceneView, LivesWithoutACase) {
  ViewState state;
  SceneView view(state, nullptr, SceneBackend::kPicture);
  view.resize(300, 300);
  view.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&view));
  view.navigation().setThroughCamera(true);
  QTest::mouseClick(view.canvas(), Qt::LeftButton, Qt::NoModifier, {100, 100});
  view.navigation().reset();
  view.grab();
}

TEST(SceneBackend, IsVtkWhereAContextCanBeHad_AndNotAskedWhereTheAnswerIsPlain) {
  int asked = 0;
  const auto decided = [&asked](const char* platform, const char* wanted, bool works) {
    return decideSceneBackend(QString::fromUtf8(platform), QString::fromUtf8(wanted), [&, works] {
      ++asked;
      return works;
    });
  };
  EXPECT_EQ(decided("xcb", "", true), SceneBackend::kVtk);
  EXPECT_EQ(decided("xcb", "", false), SceneBackend::kPicture);
  EXPECT_EQ(decided("xcb", "picture", true), SceneBackend::kPicture);
  for (const char* platform : {"offscreen", "minimal", "wayland", "vnc", ""})
    EXPECT_EQ(decided(platform, "", true), SceneBackend::kPicture) << platform;
  EXPECT_EQ(asked, 2) << "for a context";
  EXPECT_EQ(sceneBackend(), SceneBackend::kPicture) << "in this test";
  EXPECT_TRUE(sceneIsDrawnInSoftware());
}

const QSize kCanvas(420, 340);

Viewpoint someView(const SceneContent& content) {
  OrbitCamera orbit;
  BoundingBox box = content.bounds;
  for (const Frustum& frustum : content.frusta) {
    box.minimum_m = box.minimum_m.cwiseMin(frustum.apex_m);
    box.maximum_m = box.maximum_m.cwiseMax(frustum.apex_m);
  }
  orbit.frame(box);
  return orbit.viewpoint(kCanvas);
}

TEST(ScenePicture, ShowsTheMeshExactlyWhereTheCoreRendersIt) {
  ViewState state;
  test::showRun(state);
  const SceneContent content = sceneContent(state);
  const Viewpoint view = someView(content);
  SceneLook look;
  look.shown = {true, false, false, false, false, false};
  look.background = QColor(255, 0, 255);
  const QImage picture = drawScenePicture(content, look, view, std::nullopt);
  ASSERT_EQ(picture.size(), kCanvas);
  const std::vector<std::int32_t> face = test::renderedFaces(content, view);
  int covered = 0;
  for (int y = 0; y < kCanvas.height(); ++y)
    for (int x = 0; x < kCanvas.width(); ++x) {
      const bool mesh = face[static_cast<std::size_t>(y * kCanvas.width() + x)] >= 0;
      EXPECT_EQ(picture.pixelColor(x, y) != look.background, mesh);
      covered += mesh ? 1 : 0;
    }
  EXPECT_GT(covered, 1000);
}

TEST(ScenePicture, ShowsEveryFrustumAndThePoints) {
  ViewState state;
  test::showRun(state);
  state.selectTemplate(0);
  const SceneContent content = sceneContent(state);
  const Viewpoint view = someView(content);
  const QImage with = drawScenePicture(content, SceneLook(), view, std::nullopt, 2.0);
  EXPECT_EQ(with.size(), 2 * kCanvas);
  for (const Frustum& frustum : content.frusta)
    EXPECT_GT(test::pixelsLike(with, frustum.color, 7), 50) << frustum.label.toStdString();
  SceneLook bare;
  bare.shown.points = false;
  EXPECT_NE(drawScenePicture(content, bare, view, std::nullopt, 2.0), with);
}

TEST(ScenePicture, IsItsBackgroundWithoutACase) {
  OrbitCamera orbit;
  SceneLook look;
  look.background = QColor(1, 2, 3);
  const QImage picture =
      drawScenePicture(SceneContent(), look, orbit.viewpoint(kCanvas), std::nullopt);
  EXPECT_EQ(picture.pixelColor(10, 10), look.background);
}

}  // namespace
}  // namespace boresight::ui
