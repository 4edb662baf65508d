// SPDX-License-Identifier: Apache-2.0
#include "core/accept/self_similarity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

struct Found {
  std::vector<std::byte> memory = std::vector<std::byte>(std::size_t{1} << 20);
  SelfSimilarity similarity;
  std::vector<SelfShift> shifts;
};

Found similaritiesOf(const EdgeRender& render, int reach_px, double least) {
  Found found;
  Arena arena(found.memory);
  found.similarity.create(render.edges.width, render.edges.height, arena);
  EXPECT_FALSE(arena.exhausted());
  found.similarity.begin(render, reach_px, reach_px, least);
  int steps = 0;
  while (!found.similarity.step() && steps < 10000) ++steps;
  found.shifts.assign(found.similarity.shifts().begin(), found.similarity.shifts().end());
  return found;
}

/// A render made of dots, each with a normal, all at 1 m.
struct Dots {
  Camera camera = pinholeCamera();
  std::vector<EdgePixel> pixels;

  void add(int x, int y, int normal_x, int normal_y) {
    EdgePixel pixel;
    pixel.x = static_cast<std::int16_t>(x);
    pixel.y = static_cast<std::int16_t>(y);
    pixel.normal_x = static_cast<std::int8_t>(normal_x);
    pixel.normal_y = static_cast<std::int8_t>(normal_y);
    pixel.depth_m = 1.0F;
    pixels.push_back(pixel);
  }

  EdgeRender render(std::vector<std::byte>& memory) {
    memory.resize(std::size_t{4} << 20);
    Arena arena(memory);
    EdgeRender made = createEdgeRender(camera.width, camera.height,
                                       static_cast<std::int32_t>(pixels.size()), arena);
    const auto before = [](const EdgePixel& a, const EdgePixel& b) {
      return a.y != b.y ? a.y < b.y : a.x < b.x;
    };
    const auto same = [](const EdgePixel& a, const EdgePixel& b) {
      return a.x == b.x && a.y == b.y;
    };
    std::stable_sort(pixels.begin(), pixels.end(), before);
    pixels.erase(std::unique(pixels.begin(), pixels.end(), same), pixels.end());
    made.pixel_count = static_cast<std::int32_t>(pixels.size());
    std::copy(pixels.begin(), pixels.end(), made.pixels.begin());
    for (const EdgePixel& pixel : pixels) {
      made.edges.set(pixel.x, pixel.y);
      ++made.row_begin[static_cast<std::size_t>(pixel.y) + 1];
    }
    for (std::size_t y = 1; y < made.row_begin.size(); ++y)
      made.row_begin[y] += made.row_begin[y - 1];
    made.camera = camera;
    return made;
  }
};

/// Random dots and a copy of most of them somewhere else: that displacement is found, and in space.
TEST(SelfSimilarity, FindsWhereACopyLies) {
  Random random(17);
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    Dots dots;
    const int dx = 30 + static_cast<int>(random.below(70));
    const int dy = static_cast<int>(random.below(160)) - 80;
    for (int i = 0; i < 150; ++i) {
      const int x = 100 + static_cast<int>(random.below(250));
      const int y = 120 + static_cast<int>(random.below(250));
      const double angle = random.uniform(-3.0, 3.0);
      const int normal_x = static_cast<int>(127.0 * std::cos(angle));
      const int normal_y = static_cast<int>(127.0 * std::sin(angle));
      dots.add(x, y, normal_x, normal_y);
      if (i % 10 != 0) dots.add(x + dx, y + dy, normal_x, normal_y);
    }
    std::vector<std::byte> memory;
    const EdgeRender render = dots.render(memory);
    const Found found = similaritiesOf(render, 200, 0.25);
    ASSERT_GE(found.shifts.size(), 2u);
    SelfShift shift = found.shifts.front();
    if (shift.x_px < 0) shift = found.shifts[1];
    EXPECT_NEAR(shift.x_px, dx, 4);
    EXPECT_NEAR(shift.y_px, dy, 4);
    EXPECT_GT(shift.similarity, 0.25);
    EXPECT_NEAR(shift.displacement_in_camera_m.x(), dx / dots.camera.fx, 0.002);
    EXPECT_NEAR(shift.displacement_in_camera_m.y(), dy / dots.camera.fy, 0.002);
    EXPECT_NEAR(shift.displacement_in_camera_m.z(), 0.0, 1e-6);
  }
}

/// A straight edge looks the same along itself, which is no other place; and the far side of a bar
/// is not its near side.
TEST(SelfSimilarity, TakesNeitherALineAlongItselfNorTheOtherSide) {
  Dots dots;
  for (int x = 60; x < 450; ++x) {
    dots.add(x, 200, 0, 127);
    dots.add(x, 240, 0, -127);
  }
  std::vector<std::byte> memory;
  const EdgeRender render = dots.render(memory);
  EXPECT_TRUE(similaritiesOf(render, 200, 0.2).shifts.empty());
}

TEST(SelfSimilarity, FindsThePitchOfARailInSpace) {
  const Case scene = railCase(Ends::kSeen, 0.0, 1.0, 1);
  const Rendering rendering = renderEdges(scene.solid, scene.camera, scene.truth);
  const Found found = similaritiesOf(rendering.edges, 160, 0.3);
  ASSERT_GE(found.shifts.size(), 2u);
  const Eigen::Vector3d pitch_m = scene.truth.matrix().col(0) * kPitch_m;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d& at_m =
        found.shifts[static_cast<std::size_t>(i)].displacement_in_camera_m;
    EXPECT_LT(std::min((at_m - pitch_m).norm(), (at_m + pitch_m).norm()), 0.001);
  }
}

TEST(SelfSimilarity, FindsNothingAboutAStationWithoutRepeatedFeatures) {
  const Rendering rendering = renderEdges(stationMesh(), pinholeCamera(), truthPose());
  EXPECT_TRUE(similaritiesOf(rendering.edges, 160, 0.3).shifts.empty());
}

TEST(SelfSimilarity, AnEmptyRenderHasNone) {
  Dots dots;
  dots.add(5, 5, 127, 0);
  std::vector<std::byte> memory;
  EdgeRender render = dots.render(memory);
  render.pixel_count = 0;
  EXPECT_TRUE(similaritiesOf(render, 200, 0.05).shifts.empty());
  EXPECT_TRUE(similaritiesOf(render, 0, 0.05).shifts.empty());
}

}  // namespace
}  // namespace boresight::test
