// SPDX-License-Identifier: Apache-2.0
// What VTK draws, under a display of its own; see CMakeLists.txt. BORESIGHT_PICTURES names a folder
// that keeps what was seen.
#include <gtest/gtest.h>
#include <QTest>
#include <QtWidgets>

#include <cstdio>
#include <vector>

#include "tests/ui/scene/scene_fixture.h"
#include "ui/scene/scene_view.h"

namespace boresight::ui {
namespace {

/// The scene of a finished run on the screen.
class ScenePixels : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(view_.backend(), SceneBackend::kVtk);
    test::showRun(state_);
    view_.resize(700, 560);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    view_.refresh();
  }

  /// The whole widget as it is on the screen.
  QImage shot(const char* name) {
    QApplication::processEvents();
    const QImage picture = view_.grab().toImage().convertToFormat(QImage::Format_RGB32);
    const QString folder = qEnvironmentVariable("BORESIGHT_PICTURES");
    if (!folder.isEmpty())
      picture.save(QStringLiteral("%1/scene-%2.png").arg(folder, QString::fromUtf8(name)));
    return picture;
  }
  /// The canvas alone.
  QImage canvasShot(const char* name) {
    return shot(name).copy(QRect(view_.canvas()->pos(), view_.canvas()->size()));
  }
  void show(bool mesh, bool points) {
    const QMenu* show = view_.findChild<QToolButton*>(QStringLiteral("show"))->menu();
    for (QAction* action : show->actions())
      if (action->isCheckable()) action->setChecked(false);
    view_.findChild<QAction*>(QStringLiteral("showMesh"))->setChecked(mesh);
    view_.findChild<QAction*>(QStringLiteral("showPoints"))->setChecked(points);
  }

  /// With the image, which would else arrive between two pictures.
  void lookThroughCamera() {
    view_.navigation().setThroughCamera(true);
    ASSERT_TRUE(QTest::qWaitFor([this] { return view_.backdropReady(); }, 60000));
  }

  ViewState state_;
  SceneView view_{state_};
};

/// A mask of the canvas, and its border: set pixels with a neighbour that is not.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<bool> bits;

  template <class Holds>
  Mask(int w, int h, const Holds& holds) : width(w), height(h) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) bits.push_back(holds(x, y));
  }
  bool get(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           bits[static_cast<std::size_t>(y * width + x)];
  }
  bool border(int x, int y) const {
    if (!get(x, y) || x == 0 || y == 0 || x == width - 1 || y == height - 1) return false;
    return !get(x - 1, y) || !get(x + 1, y) || !get(x, y - 1) || !get(x, y + 1);
  }
  bool borderNear(int x, int y) const {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (border(x + dx, y + dy)) return true;
    return false;
  }
};

/// Share of one mask's border that has the other's within one pixel, below the note at the top.
double borderShare(const Mask& of, const Mask& in) {
  int count = 0;
  int met = 0;
  for (int y = 30; y < of.height - 2; ++y)
    for (int x = 2; x < of.width - 2; ++x) {
      if (!of.border(x, y)) continue;
      ++count;
      met += in.borderNear(x, y) ? 1 : 0;
    }
  EXPECT_GT(count, 300);
  return static_cast<double>(met) / count;
}

Mask renderedMask(const SceneView& view) {
  const Viewpoint at = view.viewpoint();
  const std::vector<std::int32_t> face = test::renderedFaces(view.content(), at);
  return Mask(at.camera.width, at.camera.height, [&](int x, int y) {
    return face[static_cast<std::size_t>(y * at.camera.width + x)] >= 0;
  });
}

Mask difference(const QImage& a, const QImage& b) {
  return Mask(a.width(), a.height(), [&](int x, int y) { return a.pixel(x, y) != b.pixel(x, y); });
}

TEST_F(ScenePixels, ShowsEveryFrustumInItsColour_TheSilhouetteWhereTheCoreDrawsIt) {
  const QImage picture = canvasShot("free");
  for (const Frustum& frustum : view_.content().frusta)
    EXPECT_GT(test::pixelsLike(picture, frustum.color, 12), 100) << frustum.label.toStdString();
  for (const bool through : {false, true}) {
    if (through) lookThroughCamera();
    view_.setMeshOpacity(1.0);
    show(false, false);
    const QImage without = canvasShot("without-mesh");
    show(true, false);
    const QImage with = canvasShot(through ? "silhouette-through" : "silhouette");
    const Mask drawn = difference(with, without);
    const Mask expected = renderedMask(view_);
    ASSERT_EQ(drawn.bits.size(), expected.bits.size());
    const double found = borderShare(expected, drawn);
    const double right = borderShare(drawn, expected);
    std::printf(
        "%s: %.2f %% of the core's border drawn within 1 px, %.2f %% of the drawn one "
        "rendered\n",
        through ? "through the camera" : "from aside", 100.0 * found, 100.0 * right);
    EXPECT_GE(found, 0.99);
    EXPECT_GE(right, 0.99);
  }
}

TEST_F(ScenePixels, DrawsTemplatesWhereTheyArePicked) {
  lookThroughCamera();  // from where they are seen
  show(true, false);
  const QImage without = canvasShot("without-points");
  show(true, true);
  const Mask points = difference(canvasShot("points"), without);
  int tried = 0;
  for (const ScenePoint& point : view_.content().points) {
    const QPointF at = view_.viewpoint().toCanvas(point.at_m).value();
    const int expected = pickTemplate(view_.content(), view_.viewpoint(), at);
    if (expected != point.template_index || ++tried > 8) continue;
    EXPECT_TRUE(points.get(at.toPoint().x(), at.toPoint().y())) << expected;
    state_.selectTemplate(-1);
    QTest::mouseClick(view_.canvas(), Qt::LeftButton, Qt::NoModifier, at.toPoint());
    EXPECT_EQ(state_.selectedTemplate(), expected);
  }
  EXPECT_GT(tried, 3);
}

TEST_F(ScenePixels, LaysTheMeshOverTheImage) {
  lookThroughCamera();
  const QImage light = shot("through");
  QPalette dark = QApplication::palette();
  for (const auto role : {QPalette::WindowText, QPalette::ButtonText, QPalette::Text})
    dark.setColor(role, Qt::white);
  for (const auto role : {QPalette::Window, QPalette::Button, QPalette::Base})
    dark.setColor(role, QColor(45, 45, 48));
  view_.setPalette(dark);
  EXPECT_NE(shot("through-dark"), light);
  view_.navigation().setThroughCamera(false);
  state_.selectTemplate(3);
  state_.setNudgedPose(state_.currentCase()->source.camera_from_station_seed);
  view_.refresh();
  shot("free-dark");
  view_.navigation().lookFrom(StandardView::kFront);
  shot("front-dark");
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
