// SPDX-License-Identifier: Apache-2.0
#include "core/accept/edge_support.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

constexpr int kDisplacements[4][2] = {{11, 0}, {0, 11}, {-11, 0}, {0, -11}};

EdgeSupport supportAt(const Case& scene, const Pose& pose, int level = 0) {
  std::vector<std::byte> memory(std::size_t{8} << 20);
  Arena arena(memory);
  EdgeMap edges;
  EXPECT_EQ(detectEdges(scene.picture->view(), scene.ignore, {}, arena, edges), Status::kOk);
  const Rendering rendering = renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
  return measureEdgeSupport(rendering.edges, level, edges, scene.picture->view(), scene.ignore);
}

TEST(EdgeSupport, IsHighAtTheTruthAndLowElsewhere) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(1, distorted);
    const EdgeSupport truth = supportAt(scene, scene.truth);
    EXPECT_GT(truth.coverage(), 0.6);
    EXPECT_GT(truth.explanation(), 0.9);
    EXPECT_GT(truth.share(), SupportOptions().min_support * 2.0);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const EdgeSupport wrong = supportAt(scene, stationCase(seed).seed);
      EXPECT_LT(wrong.share(), SupportOptions().min_support) << seed;
      EXPECT_LT(wrong.explanation(), 0.5);
      EXPECT_GT(wrong.rendered, 1000);
    }
  }
}

/// At the finer level every other one: at most 3000.
TEST(EdgeSupport, CoverageCountsRenderedEdgePixels) {
  Case scene = stationCase(1);
  Mask mask(512, 512);
  mask.fill(90, 110, 260, 300);
  const Pose pose = displacedSeed(scene.truth, scene.uncertainty, 0.02, 3);
  for (const int level : {0, 1}) {
    const Rendering rendering = renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
    const EdgeRender& render = rendering.edges;
    for (const bool masked : {false, true}) {
      scene.ignore = masked ? &mask.bits : nullptr;
      const int stride = level == 0 ? 2 : 1;
      const int places = (render.pixel_count + stride - 1) / stride;
      ASSERT_GT(render.pixel_count, (stride - 1) * 3000);
      ASSERT_LE(places, 3000);
      const EdgeSearch search(kSupportDerivativeSigma_px);
      const double scale = level == 0 ? 1.0 : 2.0;
      int looked[2] = {0, 0};
      int near[2] = {0, 0};
      for (int i = 0; i < places; ++i) {
        const EdgePixel& pixel = render.pixel(stride * i);
        const Eigen::Vector2d normal(pixel.normal_x / 127.0, pixel.normal_y / 127.0);
        // In place, and displaced in one of four directions in turn.
        for (const int displaced : {0, 1}) {
          const Eigen::Vector2d at =
              Eigen::Vector2d(pixel.x, pixel.y) + 0.01 * pixel.offset * normal +
              displaced * Eigen::Vector2d(kDisplacements[i % 4][0], kDisplacements[i % 4][1]);
          const Eigen::Vector2d place = at * scale + Eigen::Vector2d::Constant(0.5 * (scale - 1.0));
          const int x = std::clamp(static_cast<int>(std::lround(place.x())), 0, 511);
          const int y = std::clamp(static_cast<int>(std::lround(place.y())), 0, 511);
          if (masked && mask.bits.get(x, y)) continue;
          ++looked[displaced];
          const EdgePeak peak = search.find(scene.picture->view(), scene.ignore, place, normal,
                                            4.0 * scale, kSupportMinGradient);
          near[displaced] += peak.gradient != 0.0 && std::abs(peak.offset_px) <= scale ? 1 : 0;
        }
      }
      const EdgeSupport support = supportAt(scene, pose, level);
      // A place may fall between two pixels.
      EXPECT_NEAR(support.rendered, looked[0], 2);
      EXPECT_NEAR(support.covered, near[0], 2);
      EXPECT_NEAR(support.displaced, looked[1], 2);
      EXPECT_NEAR(support.displaced_covered, near[1], 2);
      EXPECT_GT(near[0], near[1]);
      EXPECT_EQ(support.rendered < places - 50, masked);
      EXPECT_TRUE(masked || support.rendered == places);
    }
  }
}

/// Random bits, of a width that ends within a word. Memory before and after the edges is set.
TEST(EdgeSupport, Explanation_EqualsABruteForceCount) {
  constexpr int kWidth = 190;
  constexpr int kHeight = 37;
  constexpr int kAroundRows = 16;
  const Picture flat = flatPicture(kWidth, kHeight, 9);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Mask around(kWidth, kHeight + 2 * kAroundRows);
    Mask rendered(kWidth, kHeight);
    Mask mask(kWidth, kHeight);
    Mask test_edges(kWidth, kHeight);
    around.fill(0, 0, kWidth, kHeight + 2 * kAroundRows);
    rendered.bits.words = around.bits.words.subspan(
        static_cast<std::size_t>(kAroundRows * rendered.bits.words_per_row),
        rendered.bits.words.size());
    rendered.bits.clear();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (random.below(12) == 0) rendered.bits.set(x, y);
        if (random.below(3) != 0) mask.bits.set(x, y);
        if (random.below(4) == 0) test_edges.bits.set(x, y);
      }
    }
    EdgeRender render;
    render.edges = rendered.bits;
    render.mask = mask.bits;
    std::vector<std::int32_t> row_begin(kHeight + 1, 0);  // no pixel
    render.row_begin = row_begin;
    EdgeMap edges;
    edges.level[2] = test_edges.bits;
    const auto nearEdge = [&](int x, int y) {
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
          if (rendered.bits.contains(u, v) && rendered.bits.get(u, v)) return 1;
      return 0;
    };
    int seen = 0;
    int explained = 0;
    int displaced = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (!mask.bits.get(x, y) || !test_edges.bits.get(x, y)) continue;
        ++seen;
        explained += nearEdge(x, y);
        for (const auto& by : kDisplacements) displaced += nearEdge(x - by[0], y - by[1]);
      }
    }
    const EdgeSupport support = measureEdgeSupport(render, 2, edges, flat.view(), nullptr);
    EXPECT_EQ(support.seen, seen);
    EXPECT_EQ(support.explained, explained);
    EXPECT_EQ(support.displaced_explained, displaced);
    EXPECT_GT(seen, explained);
    EXPECT_EQ(support.rendered, 0);
  }
}

/// A place beyond the image is looked up at the nearest pixel of the mask.
TEST(EdgeSupport, DisplacedBeyondTheImage_IsIgnoredAsItsBorder) {
  const Picture flat = flatPicture(100, 60, 9);
  const EdgeSearch search(kSupportDerivativeSigma_px);
  struct Place {
    std::int16_t x, y;
    int border_x, border_y;
  };
  const Place places[] = {{97, 30, 99, 30}, {50, 57, 50, 59}, {2, 30, 0, 30}, {50, 2, 50, 0}};
  for (int direction = 0; direction < 4; ++direction)
    for (const bool ignored : {false, true}) {
      Mask mask(100, 60);
      const Place& place = places[direction];
      if (ignored) mask.bits.set(place.border_x, place.border_y);
      EdgePixel pixel;
      pixel.x = place.x;
      pixel.y = place.y;
      pixel.normal_x = 127;
      std::int32_t looked = 0;
      std::int32_t covered = 0;
      countEdge(pixel, direction, 0, search, flat.view(), &mask.bits, looked, covered);
      EXPECT_EQ(looked, ignored ? 0 : 1) << direction;
      EXPECT_EQ(covered, 0);
    }
}

TEST(EdgeSupport, ShareIsTheExcessOverChance) {
  EXPECT_EQ(EdgeSupport().share(), 0.0);
  EdgeSupport support{.rendered = 10,
                      .covered = 6,
                      .displaced = 8,
                      .displaced_covered = 2,
                      .seen = 20,
                      .explained = 10,
                      .displaced_explained = 16};
  EXPECT_DOUBLE_EQ(support.chanceCoverage(), 0.25);
  EXPECT_DOUBLE_EQ(support.chanceExplanation(), 0.2);
  EXPECT_NEAR(support.share(), (2.0 * (0.35 / 0.75) + 0.3 / 0.8) / 3.0, 1e-12);
  support.displaced_explained = 80;  // everything by chance
  EXPECT_NEAR(support.share(), 2.0 * (0.35 / 0.75) / 3.0, 1e-12);
  support.covered = 1;  // less than by chance
  EXPECT_EQ(support.share(), 0.0);
}

}  // namespace
}  // namespace boresight::test
