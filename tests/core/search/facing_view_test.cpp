// SPDX-License-Identifier: Apache-2.0
#include "core/search/facing_view.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/localizer/scene.h"

namespace boresight {
namespace {

SearchProblem searchOf(const test::Case& scene) {
  const LocalizationProblem problem = scene.problem();
  return {problem.image,
          problem.color,
          problem.ignore,
          problem.camera,
          problem.mesh,
          matchedBounds(problem.mesh),
          problem.camera_from_station_seed,
          problem.uncertainty};
}

ViewSize sizeOf(double span_px) {
  ViewSize size;
  size.span_px = span_px;
  size.margin_px = 10.0;
  size.most_px = 300;
  return size;
}

/// The image of a view with its memory.
struct ViewImage {
  ViewImage(const SearchProblem& problem, const FacingView& view, int channel = 0)
      : block(1 << 20) {
    Arena arena(block);
    image = SmallImage::create(300 * 300, arena);
    fillViewRows(problem, view, 0, view.camera.height, channel, image);
  }
  std::vector<std::byte> block;
  SmallImage image;
};

TEST(FacingView, TurnedTowardsAPoint_SeesItOnItsAxis) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point(random.normal(), random.normal(), 0.2 + random.uniform());
    const Eigen::Vector3d seen = viewTowards(point) * point;
    EXPECT_NEAR(seen.x(), 0.0, 1e-12);
    EXPECT_NEAR(seen.y(), 0.0, 1e-12);
    EXPECT_NEAR(seen.z(), point.norm(), 1e-12);
  }
}

TEST(FacingView, OfAScene_HasItInTheMiddleAtTheSpanAsked) {
  for (const bool distorted : {false, true}) {
    const test::Case scene = test::stationCase(1, distorted);
    const SearchProblem problem = searchOf(scene);
    FacingView view;
    ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(100.0), view));
    EXPECT_NEAR(view.span_px, 100.0, 1e-9);
    Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9), most = -least, middle;
    for (const Eigen::Vector3f& vertex : scene.solid.vertices) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(project(view.camera,
                          view.view_from_camera * (scene.truth * vertex.cast<double>()), pixel));
      least = least.cwiseMin(pixel);
      most = most.cwiseMax(pixel);
    }
    EXPECT_NEAR((most - least).maxCoeff(), 100.0, 3.0);
    EXPECT_GE(least.minCoeff(), 5.0);
    EXPECT_LE(most.x(), view.camera.width - 5.0);
    ASSERT_TRUE(project(view.camera, view.view_from_camera * (scene.truth * problem.scene.centre()),
                        middle));
    EXPECT_NEAR(middle.x(), view.camera.cx, 1e-6);
    EXPECT_NEAR(middle.y(), view.camera.cy, 1e-6);
  }
}

TEST(FacingView, SceneBehindTheCameraOrOutOfSight_HasNone) {
  const test::Case scene = test::stationCase(1);
  FacingView view;
  Pose behind = scene.truth;
  behind.translation_m.z() = -0.5;
  EXPECT_FALSE(faceScene(searchOf(scene), behind, sizeOf(100.0), view));
  Pose aside = scene.truth;
  aside.translation_m.x() += 3.0;
  EXPECT_FALSE(faceScene(searchOf(scene), aside, sizeOf(100.0), view));
}

/// Each pixel is about the mean of the image over what it covers.
TEST(FacingView, ImageOfAView_ShowsTheRealOne) {
  const test::Case scene = test::stationCase(1, true);
  const SearchProblem problem = searchOf(scene);
  FacingView view;
  ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(90.0), view));
  const ViewImage shown(problem, view);
  const SmallImage& image = shown.image;
  const int half = static_cast<int>(0.5 / view.pixels_per_px);
  int known = 0;
  for (int y = 0; y < image.height; y += 3)
    for (int x = 0; x < image.width; x += 3) {
      const auto at = static_cast<std::size_t>(y * image.width + x);
      if (image.seen[at] == 0) continue;
      ++known;
      Eigen::Vector3d ray;
      Eigen::Vector2d pixel;
      ASSERT_TRUE(unproject(view.camera, Eigen::Vector2d(x, y), ray));
      ASSERT_TRUE(project(problem.camera, view.view_from_camera.inverse() * ray, pixel));
      double sum = 0.0;
      int count = 0;
      for (int v = -half; v <= half; ++v)
        for (int u = -half; u <= half; ++u, ++count)
          sum += problem.image.at(static_cast<int>(pixel.x() + 0.5) + u,
                                  static_cast<int>(pixel.y() + 0.5) + v);
      EXPECT_NEAR(image.value[at], sum / count, 24.0) << x << " " << y;
    }
  EXPECT_GT(known, 500);
}

TEST(FacingView, ChannelOfAColorImage_IsShownAsThatChannelAlone) {
  const test::Case scene = test::stationCase(1, true);
  SearchProblem problem = searchOf(scene);
  FacingView view;
  ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(90.0), view));
  const ViewImage of_gray(problem, view);
  // The second channel is the gray image, the others are something else.
  const auto width = static_cast<std::size_t>(problem.image.width);
  std::vector<std::uint8_t> color(3 * width * static_cast<std::size_t>(problem.image.height));
  for (std::size_t i = 0; i < color.size() / 3; ++i) {
    color[3 * i] = static_cast<std::uint8_t>(i % 251);
    color[3 * i + 1] = problem.image.at(static_cast<int>(i % width), static_cast<int>(i / width));
  }
  problem.color = {color.data(), problem.image.width, problem.image.height,
                   3 * problem.image.width};
  const ViewImage of_second(problem, view, 1);
  const ViewImage of_first(problem, view, 0);
  const auto pixels = static_cast<std::size_t>(view.camera.width * view.camera.height);
  const auto valuesOf = [pixels](const ViewImage& shown) {
    return std::vector<std::uint8_t>(
        shown.image.value.begin(), shown.image.value.begin() + static_cast<std::ptrdiff_t>(pixels));
  };
  EXPECT_EQ(valuesOf(of_second), valuesOf(of_gray));
  EXPECT_NE(valuesOf(of_first), valuesOf(of_gray));
  EXPECT_EQ(channelsOf(problem), 3);
}

TEST(FacingView, IgnoredPixels_AreNotKnown) {
  test::Case scene = test::stationCase(1);
  test::Mask mask(512, 512);
  mask.fill(0, 0, 512, 512);
  scene.ignore = &mask.bits;
  const SearchProblem problem = searchOf(scene);
  FacingView view;
  ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(90.0), view));
  const ViewImage shown(problem, view);
  const SmallImage& image = shown.image;
  for (int i = 0; i < image.width * image.height; ++i)
    EXPECT_EQ(image.seen[static_cast<std::size_t>(i)], 0);
}

}  // namespace
}  // namespace boresight
