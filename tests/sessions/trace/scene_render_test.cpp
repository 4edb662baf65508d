// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/scene_render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sessions/io/images/image_file.h"
#include "sessions/trace/overlay.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

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

constexpr int kWidth = 600;
constexpr int kHeight = 400;
constexpr std::uint8_t kGray = 90;

/// A square of side 0.2 m in front of a camera that sees it 200 px wide in the image's middle.
class Overlay : public testing::Test {
 protected:
  ColorImage draw(const std::vector<OverlayLayer>& layers) const {
    return drawOverlay({pixels_.data(), kWidth, kHeight, kWidth}, camera_, square_.view(), layers);
  }
  static ColorBgr at(const ColorImage& image, int x, int y) {
    const auto first = 3 * static_cast<std::size_t>(y * image.width + x);
    return {image.bgr[first], image.bgr[first + 1], image.bgr[first + 2]};
  }
  /// Columns of row 250, below the legend, that have the colour.
  static std::vector<int> columnsOf(const ColorImage& image, const ColorBgr& color) {
    std::vector<int> columns;
    for (int x = 0; x < image.width; ++x)
      if (at(image, x, 250) == color) columns.push_back(x);
    return columns;
  }
  static Pose shifted(double x_m, double z_m = 1.0) {
    return {Eigen::Quaterniond::Identity(), {x_m, 0.0, z_m}};
  }

  const Camera camera_ = test::makePinhole(kWidth, kHeight, 1000.0);
  const std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kWidth * kHeight, kGray);
  const Square square_;
};

TEST_F(Overlay, DrawsEachPoseInItsColour) {
  const ColorImage image =
      draw({{"seed", shifted(0.05), kSeedColor}, {"result", shifted(0.0), kResultColor}});
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  // Row 250 crosses the upright sides: of the result at 299.5 +- 100, of the seed 50 px further.
  const std::vector<int> result = columnsOf(image, kResultColor);
  const std::vector<int> seed = columnsOf(image, kSeedColor);
  ASSERT_FALSE(result.empty() || seed.empty());
  EXPECT_NEAR(result.front(), 199.5, 2.0);
  EXPECT_NEAR(result.back(), 399.5, 2.0);
  EXPECT_NEAR(seed.front(), 249.5, 2.0);
  EXPECT_NEAR(seed.back(), 449.5, 2.0);
  EXPECT_EQ(at(image, 300, 250), (ColorBgr{kGray, kGray, kGray}));
}

TEST_F(Overlay, ThinLayer_LeavesTheLayerBelowVisible) {
  const ColorImage image =
      draw({{"result", shifted(0.0), kResultColor}, {"truth", shifted(0.0), kTruthColor, true}});
  const std::vector<int> truth = columnsOf(image, kTruthColor);
  const std::vector<int> result = columnsOf(image, kResultColor);
  ASSERT_FALSE(truth.empty() || result.empty());
  EXPECT_EQ(result.front(), truth.front() - 1);
  EXPECT_EQ(result.back(), truth.back() + 1);
}

TEST_F(Overlay, HasALegendOnlyWithLayersAndIsWrittenAsItIs) {
  EXPECT_THAT(draw({}).bgr, testing::Each(kGray));
  const ColorImage behind = draw({{"behind", shifted(0.0, -1.0), kSeedColor}});
  EXPECT_TRUE(columnsOf(behind, kSeedColor).empty()) << "it cannot be rendered";
  const ColorImage image = draw({{"seed", shifted(0.0), kSeedColor}});
  int bright = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 150; ++x) bright += at(image, x, y)[0] > kGray + 60 ? 1 : 0;
  EXPECT_GT(bright, 20);
  const test::TemporaryFolder folder;
  writeColorPng(folder / "overlay.png", image);
  const GrayImage read = readImage(folder / "overlay.png");
  EXPECT_EQ(read.width, kWidth);
  EXPECT_EQ(read.height, kHeight);
  EXPECT_EQ(read.channels, 3);
  EXPECT_EQ(read.color, image.bgr);
}

}  // namespace
}  // namespace boresight::sessions
