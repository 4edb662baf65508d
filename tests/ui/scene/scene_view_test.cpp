// SPDX-License-Identifier: Apache-2.0
// Offscreen: the picture stands in for VTK, mouse and keys are real events.
#include "ui/scene/scene_view.h"

#include <gtest/gtest.h>
#include <QTest>
#include <QtWidgets>

#include "sessions/run/surface_point.h"
#include "tests/ui/scene/scene_fixture.h"

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
  view_.setThroughCamera(true);  // from where the templates are seen
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
  EXPECT_TRUE(readout().startsWith(QStringLiteral("Nothing")));
}

TEST_F(SceneViewTest, ADoubleClickShowsTheWholeScene) {
  view_.setShown({.points = false});
  wheel({300, 240}, 2);
  const double near_m = view_.orbitCamera().distance_m();
  const QPoint at = onCanvas(view_.content().bounds.centre());
  QTest::mouseDClick(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  const QString before = readout();
  QTest::mouseRelease(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  EXPECT_EQ(readout(), before) << "the second release is no click";
  EXPECT_GT(view_.orbitCamera().distance_m(), near_m);
}

TEST_F(SceneViewTest, DraggingOrbitsAndPicksNothing) {
  const double azimuth_rad = view_.orbitCamera().azimuth_rad();
  const int selected = state_.selectedTemplate();
  const QString before = readout();
  drag({300, 240}, {380, 240}, Qt::LeftButton);
  EXPECT_LT(view_.orbitCamera().azimuth_rad(), azimuth_rad);
  EXPECT_EQ(state_.selectedTemplate(), selected);
  EXPECT_EQ(readout(), before);
}

TEST_F(SceneViewTest, TheMiddleButtonAndShiftPan) {
  for (const bool shift : {false, true}) {
    const Eigen::Vector3d target_m = view_.orbitCamera().target_m();
    const double azimuth_rad = view_.orbitCamera().azimuth_rad();
    drag({300, 240}, {340, 200}, shift ? Qt::LeftButton : Qt::MiddleButton,
         shift ? Qt::ShiftModifier : Qt::NoModifier);
    EXPECT_GT((view_.orbitCamera().target_m() - target_m).norm(), 1e-4);
    EXPECT_EQ(view_.orbitCamera().azimuth_rad(), azimuth_rad);
  }
}

TEST_F(SceneViewTest, TheWheelComesNearerAndHomeGoesBack) {
  const double distance_m = view_.orbitCamera().distance_m();
  wheel({200, 200}, 2);
  EXPECT_LT(view_.orbitCamera().distance_m(), distance_m);
  QTest::keyClick(view_.canvas(), Qt::Key_Home);
  EXPECT_EQ(view_.orbitCamera().distance_m(), distance_m);
}

TEST_F(SceneViewTest, KeysLookFromFixedDirections) {
  QTest::keyClick(view_.canvas(), Qt::Key_1);
  EXPECT_NEAR(view_.orbitCamera().elevation_rad(), std::acos(0.0), 1e-12);
  QTest::keyClick(view_.canvas(), Qt::Key_3);
  EXPECT_EQ(view_.orbitCamera().elevation_rad(), 0.0);
  EXPECT_EQ(view_.orbitCamera().azimuth_rad(), 0.0);
}

TEST_F(SceneViewTest, ThroughTheCameraTheWheelKeepsThePixelUnderTheMouse) {
  QTest::keyClick(view_.canvas(), Qt::Key_V);
  ASSERT_TRUE(view_.throughCamera());
  const QPoint mouse(200, 150);
  const QPointF before = view_.imageTransform().toPixel(mouse);
  wheel(mouse, 3);
  const QPointF after = view_.imageTransform().toPixel(mouse);
  EXPECT_NEAR(after.x(), before.x(), 1e-9);
  EXPECT_NEAR(after.y(), before.y(), 1e-9);
  QTest::keyClick(view_.canvas(), Qt::Key_V);
  EXPECT_FALSE(view_.throughCamera());
}

TEST_F(SceneViewTest, ThroughTheCameraTheMeshLiesWhereTheImageShowsIt) {
  view_.setThroughCamera(true);
  view_.setThroughRole(PoseRole::kTruth);
  const Viewpoint view = view_.viewpoint();
  EXPECT_EQ(view.view_from_station.translation_m,
            test::sceneCase()->source.camera_from_station_truth->translation_m);
  // Mirrors the camera's principal point, which is not the canvas' centre.
  const QPointF centre = view_.imageTransform().toWidget(
      QPointF(test::sceneCase()->source.camera.cx, test::sceneCase()->source.camera.cy));
  EXPECT_NEAR(view.camera.cx + 0.5, centre.x(), 1e-9);
  EXPECT_NEAR(view.camera.cy + 0.5, centre.y(), 1e-9);
}

TEST_F(SceneViewTest, ANewSnapshotLeavesTheViewAlone) {
  wheel({200, 200}, 3);
  const double distance_m = view_.orbitCamera().distance_m();
  state_.setSnapshot(test::firstIterations(*test::exampleRun(), 1));
  view_.refresh();
  EXPECT_EQ(view_.orbitCamera().distance_m(), distance_m);
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
  view.setThroughCamera(true);
  QTest::mouseClick(view.canvas(), Qt::LeftButton, Qt::NoModifier, {100, 100});
  view.resetView();
  view.grab();
}

}  // namespace
}  // namespace boresight::ui
