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

/// The test edges of a picture with their memory.
struct Edges {
  std::vector<std::byte> memory;
  EdgeMap map;
  Edges(const Picture& picture, const BitImage* ignore) : memory(std::size_t{8} << 20) {
    Arena arena(memory);
    EXPECT_EQ(detectEdges(picture.view(), ignore, {}, arena, map), Status::kOk);
  }
};

EdgeSupport supportAt(const Case& scene, const Pose& pose, int level = 0) {
  const Edges edges(*scene.picture, scene.ignore);
  const Rendering rendering = renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
  return measureEdgeSupport(rendering.edges, level, edges.map, scene.picture->view(), scene.ignore);
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
  for (const int level : {0, 1}) {
    for (const bool masked : {false, true}) {
      scene.ignore = masked ? &mask.bits : nullptr;
      const Pose pose = displacedSeed(scene.truth, scene.uncertainty, 0.02, 3);
      const Rendering rendering =
          renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
      const EdgeRender& render = rendering.edges;
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
struct RandomMaps {
  static constexpr int kWidth = 190;
  static constexpr int kHeight = 37;
  static constexpr int kAround = 16;  ///< rows
  Mask around{kWidth, kHeight + 2 * kAround};
  Mask edges{kWidth, kHeight};
  Mask mask{kWidth, kHeight};
  Mask test_edges{kWidth, kHeight};

  explicit RandomMaps(std::uint64_t seed) {
    Random random(seed);
    around.fill(0, 0, kWidth, kHeight + 2 * kAround);
    edges.bits.words = around.bits.words.subspan(
        static_cast<std::size_t>(kAround * edges.bits.words_per_row), edges.bits.words.size());
    edges.bits.clear();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (random.below(12) == 0) edges.bits.set(x, y);
        if (random.below(3) != 0) mask.bits.set(x, y);
        if (random.below(4) == 0) test_edges.bits.set(x, y);
      }
    }
  }
};

TEST(EdgeSupport, Explanation_EqualsABruteForceCount) {
  const Picture flat = flatPicture(RandomMaps::kWidth, RandomMaps::kHeight, 9);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomMaps maps(seed);
    EdgeRender render;
    render.edges = maps.edges.bits;
    render.mask = maps.mask.bits;
    std::vector<std::int32_t> row_begin(RandomMaps::kHeight + 1, 0);  // no pixel
    render.row_begin = row_begin;
    EdgeMap edges;
    edges.level[2] = maps.test_edges.bits;
    const auto nearEdge = [&](int x, int y) {
      for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
          if (maps.edges.bits.contains(u, v) && maps.edges.bits.get(u, v)) return 1;
        }
      }
      return 0;
    };
    int seen = 0;
    int explained = 0;
    int displaced = 0;
    for (int y = 0; y < RandomMaps::kHeight; ++y) {
      for (int x = 0; x < RandomMaps::kWidth; ++x) {
        if (!maps.mask.bits.get(x, y) || !maps.test_edges.bits.get(x, y)) continue;
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
  for (int direction = 0; direction < 4; ++direction)
    for (const bool ignored : {false, true}) {
      Mask mask(100, 60);
      const int x = direction == 0 ? 97 : direction == 2 ? 2 : 50;
      const int y = direction == 1 ? 57 : direction == 3 ? 2 : 30;
      const int border_x = direction == 0 ? 99 : direction == 2 ? 0 : 50;
      const int border_y = direction == 1 ? 59 : direction == 3 ? 0 : 30;
      if (ignored) mask.fill(border_x, border_y, border_x + 1, border_y + 1);
      EdgePixel pixel;
      pixel.x = static_cast<std::int16_t>(x);
      pixel.y = static_cast<std::int16_t>(y);
      pixel.normal_x = 127;
      std::int32_t looked = 0;
      std::int32_t covered = 0;
      countEdge(pixel, direction, 0, search, flat.view(), &mask.bits, looked, covered);
      EXPECT_EQ(looked, ignored ? 0 : 1) << direction;
      EXPECT_EQ(covered, 0);
    }
}

TEST(EdgeSupport, FlatImageOrNoCounts_GiveNoSupport) {
  const EdgeSupport none;
  EXPECT_EQ(none.share(), 0.0);
  Case scene = stationCase(1);
  const Picture flat = flatPicture(512, 512, 50);
  scene.picture = &flat;
  const EdgeSupport support = supportAt(scene, scene.truth);
  EXPECT_EQ(support.covered, 0);
  EXPECT_EQ(support.seen, 0);
  EXPECT_EQ(support.share(), 0.0);
}

TEST(EdgeSupport, ShareIsTheExcessOverChance) {
  EdgeSupport support;
  support.rendered = 10;
  support.covered = 6;
  support.displaced = 8;
  support.displaced_covered = 2;
  support.seen = 20;
  support.explained = 10;
  support.displaced_explained = 16;
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
