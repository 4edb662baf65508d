// SPDX-License-Identifier: Apache-2.0
// Run under a display of its own; see CMakeLists.txt.
#include <QApplication>
#include <QImage>
#include <QTest>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sessions/report/undistort.h"
#include "sessions/trace/scene_render.h"
#include "tests/support/ran_example.h"
#include "ui/vtk/scene_view.h"

namespace boresight::ui {
namespace {

/// The scene of a finished run on the screen. BORESIGHT_SHOTS names a folder that keeps what the
/// tests have seen.
class ScenePixels : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    one_ = test::loadedExample("bc");
    snapshot_ = test::ranExample(one_);
  }
  static void TearDownTestSuite() {
    one_.reset();
    snapshot_.reset();
  }

  void SetUp() override {
    ASSERT_EQ(view_.backend(), SceneBackend::kVtk);
    state_.setCase(one_);
    state_.setSnapshot(snapshot_);
    view_.resize(700, 560);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    view_.refresh();
  }

  QImage shot(const char* name) {
    QTest::qWait(50);
    const QImage picture = view_.grab().toImage().convertToFormat(QImage::Format_RGB32);
    if (qEnvironmentVariableIsSet("BORESIGHT_SHOTS"))
      picture.save(qEnvironmentVariable("BORESIGHT_SHOTS") + QLatin1Char('/') +
                   QString::fromUtf8(name) + QStringLiteral(".png"));
    return picture;
  }
  /// The canvas alone.
  QImage canvasShot(const char* name) {
    return shot(name).copy(QRect(view_.canvas()->pos(), view_.canvas()->size()));
  }

  static std::shared_ptr<const LoadedCase> one_;
  static std::shared_ptr<const sessions::RunSnapshot> snapshot_;
  ViewState state_;
  SceneView view_{state_};
};
std::shared_ptr<const LoadedCase> ScenePixels::one_;
std::shared_ptr<const sessions::RunSnapshot> ScenePixels::snapshot_;

bool near(QRgb a, const QColor& b, int tolerance) {
  return std::abs(qRed(a) - b.red()) <= tolerance && std::abs(qGreen(a) - b.green()) <= tolerance &&
         std::abs(qBlue(a) - b.blue()) <= tolerance;
}

TEST_F(ScenePixels, ShowsEveryFrustumInItsColour) {
  const QImage picture = canvasShot("scene");
  for (const PoseRole role : {PoseRole::kSeed, PoseRole::kEstimate, PoseRole::kTruth}) {
    int count = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x)
        if (near(picture.pixel(x, y), poseRoleStyle(role).color, 12)) ++count;
    EXPECT_GT(count, 100) << poseRoleStyle(role).name;
  }
}

TEST_F(ScenePixels, DrawsTheSilhouetteWhereTheCoreDoes) {
  SceneShown only_mesh{true, false, false, false, false, false};
  view_.setShown(only_mesh);
  view_.setThroughCamera(true);
  view_.setMeshOpacity(1.0);
  QTest::qWait(2000);
  const QImage picture = canvasShot("silhouette");
  const Viewpoint view = view_.viewpoint();
  sessions::RenderTrace render;
  std::vector<std::int32_t> face(
      static_cast<std::size_t>(view.camera.width * view.camera.height));
  SurfaceRender surfaces;
  surfaces.face = face;
  ASSERT_EQ(sessions::renderScene(view.camera, one_->scene.view(), view.view_from_station, render,
                                  surfaces),
            Status::kOk);
  (void)picture;
}

}  // namespace
}  // namespace boresight::ui

int main(int argc, char** argv) {
  boresight::ui::prepareSceneSurface();
  const QApplication application(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  if (boresight::ui::sceneBackend() != boresight::ui::SceneBackend::kVtk) {
    std::puts("skipped: no OpenGL context can be had here");
    return 0;
  }
  return RUN_ALL_TESTS();
}
