// SPDX-License-Identifier: Apache-2.0
// Offscreen: the picture stands in for VTK, mouse and keys are real events.
#include "ui/scene/scene_view.h"

#include <gtest/gtest.h>
#include <QTest>
#include <QtWidgets>

#include "sessions/trace/surface_point.h"
#include "tests/ui/pointer.h"
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
  /// In four steps.
  void drag(const QPointF& from, const QPointF& to, Qt::MouseButton button,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    const auto on = [&](double share) { return from + share * (to - from); };
    test::dragMouse(*view_.canvas(), {from, on(0.25), on(0.5), on(0.75), to}, button, modifiers);
  }
  void wheel(const QPointF& at, int notches) { test::turnWheel(*view_.canvas(), at, notches); }
  void press(Qt::Key key) { QTest::keyClick(view_.canvas(), key); }
  void hidePoints() { view_.findChild<QAction*>(QStringLiteral("showPoints"))->setChecked(false); }
  const OrbitCamera& orbit() { return view_.navigation().orbit(); }

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

TEST_F(SceneViewTest, HoveringAndAClickOnTheMeshTellThePlaceOfTheStation) {
  hidePoints();
  const QPoint at = onCanvas(view_.content().bounds.centre());
  std::optional<Eigen::Vector3d> hovered;
  QObject::connect(&view_, &SceneView::stationPlaceHovered, &view_,
                   [&](const std::optional<Eigen::Vector3d>& place) { hovered = place; });
  test::moveMouse(*view_.canvas(), at);
  ASSERT_TRUE(hovered);
  EXPECT_LT((view_.viewpoint().toCanvas(*hovered).value() - QPointF(at)).manhattanLength(), 1.5);
  const Viewpoint view = view_.viewpoint();
  const auto expected =
      sessions::surfacePointAt(view.camera, view_.content().mesh(), view.view_from_station,
                               {static_cast<double>(at.x()), static_cast<double>(at.y())});
  ASSERT_TRUE(expected);
  click({3, 3});
  EXPECT_TRUE(readout().startsWith(QStringLiteral("No object")));
  click(at);
  const QString picked = stationPlaceText(expected->in_station_m, QStringLiteral("surface"));
  EXPECT_EQ(readout(), picked);
  state_.setCase(test::loadedExample("bc"));
  view_.refresh();
  EXPECT_NE(readout(), picked) << "it is of the other case";
}

TEST_F(SceneViewTest, ADoubleClickShowsTheWholeScene) {
  hidePoints();
  wheel({300, 240}, 2);
  const double near_m = orbit().distance_m();
  const QPoint at = onCanvas(view_.content().bounds.centre());
  QTest::mouseDClick(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  const QString before = readout();
  QTest::mouseRelease(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at);
  EXPECT_EQ(readout(), before) << "the second release is no click";
  EXPECT_GT(orbit().distance_m(), near_m);
}

TEST_F(SceneViewTest, DraggingOrbitsAndPicksNothing_TheMiddleButtonAndShiftPan) {
  const double azimuth_rad = orbit().azimuth_rad();
  const int selected = state_.selectedTemplate();
  const QString before = readout();
  drag({300, 240}, {380, 240}, Qt::LeftButton);
  EXPECT_LT(orbit().azimuth_rad(), azimuth_rad);
  EXPECT_EQ(state_.selectedTemplate(), selected);
  EXPECT_EQ(readout(), before);
  for (const bool shift : {false, true}) {
    const Eigen::Vector3d target_m = orbit().target_m();
    const double turned_rad = orbit().azimuth_rad();
    drag({300, 240}, {340, 200}, shift ? Qt::LeftButton : Qt::MiddleButton,
         shift ? Qt::ShiftModifier : Qt::NoModifier);
    EXPECT_GT((orbit().target_m() - target_m).norm(), 1e-4);
    EXPECT_EQ(orbit().azimuth_rad(), turned_rad);
  }
}

TEST_F(SceneViewTest, TheWheelComesNearerHomeGoesBack_KeysLookFromFixedDirections) {
  const double distance_m = orbit().distance_m();
  wheel({200, 200}, 2);
  EXPECT_LT(orbit().distance_m(), distance_m);
  press(Qt::Key_Home);
  EXPECT_EQ(orbit().distance_m(), distance_m);
  press(Qt::Key_1);
  EXPECT_NEAR(orbit().elevation_rad(), std::acos(0.0), 1e-12);
  press(Qt::Key_3);
  EXPECT_EQ(orbit().elevation_rad(), 0.0);
  EXPECT_EQ(orbit().azimuth_rad(), 0.0);
}

TEST_F(SceneViewTest, ThroughTheCameraTheMeshLiesOnTheImage_TheWheelKeepsThePixelUnderTheMouse) {
  press(Qt::Key_V);
  ASSERT_TRUE(view_.navigation().throughCamera());
  const QPoint mouse(200, 150);
  const QPointF before = view_.navigation().image().toPixel(mouse);
  wheel(mouse, 3);
  const QPointF after = view_.navigation().image().toPixel(mouse);
  EXPECT_NEAR(after.x(), before.x(), 1e-9);
  EXPECT_NEAR(after.y(), before.y(), 1e-9);
  view_.findChild<QComboBox*>(QStringLiteral("throughRole"))
      ->setCurrentText(QStringLiteral("truth"));
  const Viewpoint view = view_.viewpoint();
  EXPECT_EQ(view.view_from_station.translation_m,
            test::sceneCase()->source.camera_from_station_truth->translation_m);
  // Mirrors the camera's principal point, which is not the canvas' centre.
  const QPointF centre = view_.navigation().image().toWidget(
      QPointF(test::sceneCase()->source.camera.cx, test::sceneCase()->source.camera.cy));
  EXPECT_NEAR(view.camera.cx + 0.5, centre.x(), 1e-9);
  EXPECT_NEAR(view.camera.cy + 0.5, centre.y(), 1e-9);
  press(Qt::Key_V);
  EXPECT_FALSE(view_.navigation().throughCamera());
}

TEST_F(SceneViewTest, FollowsTheStateWhileItIsShownAndCatchesUpAfterwards) {
  wheel({200, 200}, 3);
  const double distance_m = orbit().distance_m();
  state_.setNudgedPose(state_.shownPose());
  ASSERT_TRUE(QTest::qWaitFor([&] { return view_.content().frusta.size() == 4; }, 5000));
  view_.hide();
  state_.setNudgedPose(std::nullopt);
  QTest::qWait(20);
  EXPECT_EQ(view_.content().frusta.size(), 4u);
  view_.show();
  EXPECT_EQ(view_.content().frusta.size(), 3u);
  state_.setSnapshot(test::firstIterations(*test::exampleRun(), 1));
  view_.refresh();
  EXPECT_EQ(orbit().distance_m(), distance_m) << "a new snapshot leaves the view alone";
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

TEST(ScenePicture, ShowsTheMeshExactlyWhereTheCoreRendersIt_EveryFrustumAndThePoints) {
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
  const int covered = test::countPixels(kCanvas, [&](int x, int y) {
    const bool mesh = face[static_cast<std::size_t>(y * kCanvas.width() + x)] >= 0;
    EXPECT_EQ(picture.pixelColor(x, y) != look.background, mesh);
    return mesh;
  });
  EXPECT_GT(covered, 1000);
  const QImage empty = drawScenePicture(SceneContent(), look, view, std::nullopt);
  EXPECT_EQ(empty.pixelColor(10, 10), look.background) << "there is no case";

  state.selectTemplate(0);
  const SceneContent selected = sceneContent(state);
  const QImage with = drawScenePicture(selected, SceneLook(), view, std::nullopt, 2.0);
  EXPECT_EQ(with.size(), 2 * kCanvas);
  for (const Frustum& frustum : content.frusta)
    EXPECT_GT(test::pixelsLike(with, frustum.color, 7), 50) << frustum.label.toStdString();
  SceneLook bare;
  bare.shown.points = false;
  EXPECT_NE(drawScenePicture(selected, bare, view, std::nullopt, 2.0), with);
}

}  // namespace
}  // namespace boresight::ui
