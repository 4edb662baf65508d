// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_canvas.h"

#include <gtest/gtest.h>

#include "tests/ui/scene/scene_fixture.h"

namespace boresight::ui {
namespace {

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
