// SPDX-License-Identifier: Apache-2.0
#include "core/edges/edge_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/edges/bit_rows.h"
#include "tests/core/edges/test_images.h"
#include "tests/support/not_finite.h"

namespace boresight {
namespace {

/// A copy of a map that does not point into an arena.
struct MapCopy {
  std::vector<std::vector<std::uint64_t>> levels;
  double low_threshold;
  double high_threshold;
  std::int32_t edge_count;
  bool operator==(const MapCopy&) const = default;
};

MapCopy copyOf(const EdgeMap& map) {
  MapCopy copy{{}, map.low_threshold, map.high_threshold, map.edge_count};
  for (const BitImage& level : map.level)
    copy.levels.emplace_back(level.words.begin(), level.words.end());
  return copy;
}

MapCopy detect(const ImageView& image, const BitImage* ignore, const EdgeOptions& options) {
  TestArena arena;
  EdgeMap map;
  EXPECT_EQ(detectEdges(image, ignore, options, *arena, map), Status::kOk);
  return copyOf(map);
}

std::vector<EdgeOptions> someOptions() {
  std::vector<EdgeOptions> all(5);
  all[1].equalization = Equalization::kClahe;
  all[2].gaussian_sigma_px = 0.0;
  all[3].thresholds = CannyThresholds::kAbsolute;
  all[3].equalization = Equalization::kOff;
  all[4].gaussian_sigma_px = 8.0;
  return all;
}

TEST(DetectEdges, EachLevel_IsTheOrOfTheLevelBefore) {
  Random random(51);
  for (const Size size : kSizes) {
    const TestImage image = makeImage(Pattern::kDisks, size, random);
    TestArena arena;
    EdgeMap map;
    ASSERT_EQ(detectEdges(image.view(), nullptr, EdgeOptions{}, *arena, map), Status::kOk);
    EXPECT_EQ(map.level[0].width, size.width);
    EXPECT_EQ(map.level[0].height, size.height);
    EXPECT_EQ(map.edge_count, countBits(map.level[0]));
    for (std::size_t k = 1; k < map.level.size(); ++k) {
      const BitImage& fine = map.level[k - 1];
      TestBits expected((fine.width + 1) / 2, (fine.height + 1) / 2);
      for (int y = 0; y < fine.height; ++y)
        for (int x = 0; x < fine.width; ++x)
          if (fine.get(x, y)) expected->set(x / 2, y / 2);
      EXPECT_EQ(map.level[k].width, expected->width);
      EXPECT_EQ(map.level[k].height, expected->height);
      EXPECT_TRUE(std::ranges::equal(map.level[k].words, expected->words));
    }
  }
}

TEST(DetectEdges, CountingArena_MeasuresTheMemoryForEveryOptionWithoutPixels) {
  Random random(52);
  const TestImage image = makeImage(Pattern::kDisks, {330, 170}, random);
  TestBits ignore(image.width, image.height);
  ignoreRectangles(*ignore, random);
  for (const EdgeOptions& options : someOptions()) {
    const ImageView sizes_only{nullptr, image.width, image.height, 0};
    Arena counter;
    EdgeMap map;
    EdgeDetector detector;
    ASSERT_EQ(detector.begin(sizes_only, nullptr, options, counter, map), Status::kOk);
    EXPECT_TRUE(detector.step());
    const std::size_t output_bytes = counter.used();

    TestArena exact(counter.highWater());
    ASSERT_EQ(detectEdges(image.view(), &*ignore, options, *exact, map), Status::kOk);
    EXPECT_EQ((*exact).highWater(), counter.highWater());
    EXPECT_EQ((*exact).used(), output_bytes);
    std::size_t words = 0;
    for (const BitImage& level : map.level) words += (level.words.size() + 1) / 2 * 2;
    EXPECT_EQ(output_bytes, words * sizeof(std::uint64_t));

    TestArena small(counter.highWater() - 64);
    EXPECT_EQ(detectEdges(image.view(), &*ignore, options, *small, map), Status::kArenaTooSmall);
    EXPECT_EQ((*small).used(), 0U);
  }
}

TEST(DetectEdges, MapAndScratch_StayWithinTheirMemoryBounds) {
  const ImageView image{nullptr, 2048, 2048, 0};
  for (const EdgeOptions& options : someOptions()) {
    Arena counter;
    EdgeMap map;
    ASSERT_EQ(detectEdges(image, nullptr, options, counter, map), Status::kOk);
    EXPECT_LE(counter.used(), 700000U);
    EXPECT_LE(counter.highWater() - counter.used(), 2200000U);
  }
}

/// Nor does moving a detector between steps (as part of its owner) change the result.
TEST(EdgeDetector, InterruptedSteps_GiveTheSameMap) {
  Random random(53);
  const TestImage image = makeImage(Pattern::kDisks, {1100, 1000}, random);
  TestBits ignore(image.width, image.height);
  ignoreRectangles(*ignore, random);
  for (const EdgeOptions& options : someOptions()) {
    TestArena arena;
    // Two detectors alternate; shared state between them would change the result.
    TestArena other_arena;
    EdgeMap map;
    EdgeMap other_map;
    EdgeDetector first;
    EdgeDetector other;
    ASSERT_EQ(first.begin(image.view(), &*ignore, options, *arena, map), Status::kOk);
    ASSERT_EQ(other.begin(image.view(), nullptr, options, *other_arena, other_map), Status::kOk);
    for (int i = 0; i < 3; ++i) {
      ASSERT_FALSE(first.step());
      (void)other.step();  // its end does not matter
    }
    EdgeDetector moved = first;
    first = EdgeDetector();
    EXPECT_TRUE(first.step());
    int steps = 4;
    while (!moved.step() && steps < 10000) {
      ++steps;
      (void)other.step();
    }
    EXPECT_GT(steps, 5);
    EXPECT_TRUE(moved.step());
    EXPECT_EQ(copyOf(map), detect(image.view(), &*ignore, options));
  }
}

TEST(DetectEdges, MasksOfNothingAndOfEverything_GiveThePlainResultAndNoEdges) {
  Random random(55);
  for (const EdgeOptions& options : someOptions()) {
    for (const Size size : kSizes) {
      const TestImage image = makeImage(Pattern::kDisks, size, random);
      TestBits ignore(size.width, size.height);
      EXPECT_EQ(detect(image.view(), &*ignore, options), detect(image.view(), nullptr, options));
      fillAtRandom(*ignore, 1, random);
      EXPECT_EQ(detect(image.view(), &*ignore, options).edge_count, 0);
    }
  }
}

/// The content of ignored pixels affects only pixels within reach of the filters: the thresholds
/// stay, and so do all edges beyond the margin, as long as the margin covers the filters' reach.
TEST(DetectEdges, DoesNotDependOnTheContentOfIgnoredPixels) {
  Random random(57);
  EdgeOptions options;
  options.gaussian_sigma_px = 0.0;
  options.thresholds = CannyThresholds::kAbsolute;
  TestImage image = makeImage(Pattern::kDisks, {310, 222}, random);
  TestBits ignore(image.width, image.height);
  ignoreRectangles(*ignore, random);
  const MapCopy before = detect(image.view(), &*ignore, options);
  scramble(image, *ignore, random);
  EXPECT_EQ(detect(image.view(), &*ignore, options), before);
}

TEST(EdgeOptions, EachFieldOutOfRangeIsRefused) {
  Random random(60);
  const TestImage image = makeImage(Pattern::kNoise, {20, 20}, random);
  const auto statusOf = [&image](auto change) {
    EdgeOptions options;
    change(options);
    TestArena arena;
    EdgeMap map;
    return detectEdges(image.view(), nullptr, options, *arena, map);
  };
  EXPECT_EQ(statusOf([](EdgeOptions&) {}), Status::kOk);
  const auto refused = [&](auto change) { EXPECT_EQ(statusOf(change), Status::kInvalidOption); };
  for (const double sigma_px : {-1.0, 8.01, test::kNan})
    refused([=](EdgeOptions& o) { o.gaussian_sigma_px = sigma_px; });
  for (const double quantile : {0.0, 1.0, test::kNan})
    refused([=](EdgeOptions& o) { o.high_quantile = quantile; });
  for (const int value : {-1, 3})
    refused([=](EdgeOptions& o) { o.equalization = static_cast<Equalization>(value); });
  refused([](EdgeOptions& o) { o.low_threshold = test::kNan; });
  refused([](EdgeOptions& o) { o.high_threshold = -1.0; });
}

TEST(DetectEdges, RefusesInvalidImages) {
  Random random(61);
  const TestImage image = makeImage(Pattern::kNoise, {20, 20}, random);
  const auto statusOf = [](const ImageView& view, const BitImage* ignore) {
    TestArena arena;
    EdgeMap map;
    const Status status = detectEdges(view, ignore, EdgeOptions{}, *arena, map);
    EXPECT_EQ((*arena).used() == 0, status != Status::kOk);
    return status;
  };
  EXPECT_EQ(statusOf(image.view(), nullptr), Status::kOk);
  EXPECT_EQ(statusOf(ImageView{}, nullptr), Status::kInvalidImage);
  const std::uint8_t* data = image.pixels.data();
  for (const Size size : {Size{0, 20}, Size{20, 0}, Size{-20, 20}, Size{kMaxImageSide + 1, 1}})
    EXPECT_EQ(statusOf({data, size.width, size.height, 20}, nullptr), Status::kInvalidImage);
  EXPECT_EQ(statusOf({data, 20, 20, 19}, nullptr), Status::kInvalidImage) << "rows overlap";
  EXPECT_EQ(statusOf({data + 19 * 20, 20, 20, -20}, nullptr), Status::kOk) << "upside down";
  TestBits other_size(20, 21);
  EXPECT_EQ(statusOf(image.view(), &*other_size), Status::kInvalidImage);
}

}  // namespace
}  // namespace boresight
