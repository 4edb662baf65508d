// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/scene_render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// A square of side 0.2 m in the plane z = 0, facing -z.
struct Square {
  std::vector<Eigen::Vector3f> vertices = {
      {-0.1F, -0.1F, 0.0F}, {0.1F, -0.1F, 0.0F}, {0.1F, 0.1F, 0.0F}, {-0.1F, 0.1F, 0.0F}};
  std::vector<Face> faces = {{{0, 2, 1}}, {{0, 3, 2}}};
  std::vector<std::uint16_t> part_of_face = {0, 0};
  std::vector<ScenePart> parts = std::vector<ScenePart>(1);
  MeshView view() const { return {vertices, faces, part_of_face, parts}; }
};

Pose atDistance(double distance_m) {
  return {Eigen::Quaterniond::Identity(), {0.0, 0.0, distance_m}};
}

TEST(RenderScene, DrawsTheOutlineWhereItProjects) {
  const Square square;
  const Camera camera = test::makePinhole(300, 200, 500.0);
  std::vector<float> depth_m(300 * 200);
  SurfaceRender surfaces;
  surfaces.depth_m = depth_m;
  RenderTrace render;
  ASSERT_EQ(renderScene(camera, square.view(), atDistance(1.0), render, surfaces), Status::kOk);
  ASSERT_GT(render.pixels.size(), 300u);
  // Side 0.2 m at 1 m and 500 px: 100 px, centred.
  for (const EdgePixel& pixel : render.pixels) {
    const double x = std::abs(pixel.x - camera.cx);
    const double y = std::abs(pixel.y - camera.cy);
    EXPECT_NEAR(std::max(x, y), 50.0, 1.0);
    EXPECT_TRUE(render.edges.view().get(pixel.x, pixel.y));
  }
  ASSERT_EQ(render.row_begin.size(), 201u);
  EXPECT_EQ(render.row_begin.back(), static_cast<std::int32_t>(render.pixels.size()));
  EXPECT_TRUE(render.mask.view().get(150, 100));
  EXPECT_FALSE(render.mask.view().get(50, 100));
  EXPECT_NEAR(depth_m[100 * 300 + 150], 1.0F, 1e-6F);
  EXPECT_EQ(depth_m[100 * 300 + 50], 0.0F);
  const std::size_t middle = render.pixels.size() / 2;
  EXPECT_EQ(findEdgePixel(render.view(), render.pixels[middle].x, render.pixels[middle].y),
            static_cast<std::int32_t>(middle));
}

TEST(SceneRenderer, DrawsEveryPoseAsAFreshOneWould) {
  const Square square;
  const Camera camera = test::makePinhole(300, 200, 500.0);
  SceneRenderer renderer;
  ASSERT_EQ(renderer.create(camera, square.view()), Status::kOk);
  ASSERT_EQ(renderer.begin(atDistance(0.7)), Status::kOk);
  bool done = false;
  ASSERT_EQ(renderer.step(done), Status::kOk);  // given up after one slice
  for (const double distance_m : {1.0, 0.8, 1.3}) {
    ASSERT_EQ(renderer.begin(atDistance(distance_m)), Status::kOk);
    for (done = false; !done;) ASSERT_EQ(renderer.step(done), Status::kOk);
    const RenderTrace render = renderer.record();
    RenderTrace fresh;
    ASSERT_EQ(renderScene(camera, square.view(), atDistance(distance_m), fresh), Status::kOk);
    EXPECT_EQ(render.edges.words, fresh.edges.words);
    EXPECT_EQ(render.mask.words, fresh.mask.words);
    EXPECT_EQ(render.pixels.size(), fresh.pixels.size());
  }
}

TEST(SceneRenderer, WithoutFacesOrBeforeItIsCreated_DrawsNothing) {
  SceneRenderer renderer;
  bool done = false;
  EXPECT_EQ(renderer.begin(atDistance(1.0)), Status::kInvalidMesh);
  EXPECT_EQ(renderer.step(done), Status::kInvalidMesh);
  Square square;
  square.faces.clear();
  square.part_of_face.clear();
  RenderTrace render;
  EXPECT_EQ(renderScene(test::makePinhole(64, 64, 100.0), square.view(), atDistance(1.0), render),
            Status::kInvalidMesh);
}

}  // namespace
}  // namespace boresight::sessions
