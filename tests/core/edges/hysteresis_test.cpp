// SPDX-License-Identifier: Apache-2.0
#include "core/edges/hysteresis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/edges/gradient.h"
#include "tests/core/edges/test_images.h"

namespace boresight {
namespace {

/// Pixel by pixel, from a stack.
void growPlainly(const BitImage& candidates, BitImage& edges) {
  std::vector<std::pair<int, int>> stack;
  for (int y = 0; y < edges.height; ++y)
    for (int x = 0; x < edges.width; ++x)
      if (edges.get(x, y)) stack.emplace_back(x, y);
  while (!stack.empty()) {
    const auto [x, y] = stack.back();
    stack.pop_back();
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if (!edges.contains(u, v) || edges.get(u, v) || !candidates.get(u, v)) continue;
        edges.set(u, v);
        stack.emplace_back(u, v);
      }
    }
  }
}

/// Number of steps taken.
int grow(const BitImage& candidates, BitImage& edges, std::int32_t word_budget) {
  TestArena arena(std::size_t{1} << 17);
  Hysteresis hysteresis;
  hysteresis.begin(edges.width, edges.height, *arena);
  int steps = 1;
  while (!hysteresis.step(word_budget, candidates, edges) && steps < 1000000) ++steps;
  return steps;
}

void expectSameAsPlain(const BitImage& candidates, const BitImage& seeds, std::int32_t budget) {
  TestBits expected(seeds.width, seeds.height);
  TestBits actual(seeds.width, seeds.height);
  std::ranges::copy(seeds.words, expected->words.begin());
  std::ranges::copy(seeds.words, actual->words.begin());
  growPlainly(candidates, *expected);
  grow(candidates, *actual, budget);
  EXPECT_TRUE(std::ranges::equal(actual->words, expected->words))
      << seeds.width << " x " << seeds.height;
}

TEST(Hysteresis, EqualsPixelByPixelGrowth) {
  Random random(41);
  for (const Size size : kSizes) {
    for (const std::uint32_t density : {2U, 3U, 4U, 7U}) {
      for (const std::uint32_t seed_density : {10U, 100U, 2000U}) {
        TestBits candidates(size.width, size.height);
        TestBits seeds(size.width, size.height);
        fillAtRandom(*candidates, density, random);
        fillAtRandom(*seeds, seed_density, random);
        for (std::size_t i = 0; i < seeds->words.size(); ++i)
          seeds->words[i] &= candidates->words[i];
        expectSameAsPlain(*candidates, *seeds, 1 + static_cast<std::int32_t>(random.below(50)));
      }
    }
  }
}

/// Long runs along rows, across many words, seeded in the middle.
TEST(Hysteresis, FillsRowsInBothDirections) {
  Random random(42);
  for (int round = 0; round < 50; ++round) {
    TestBits candidates(700, 5);
    for (int y = 0; y < candidates->height; ++y)
      for (int x = 0; x < candidates->width; ++x)
        if (random.below(150) != 0) candidates->set(x, y);
    TestBits seeds(700, 5);
    const int seed_x = static_cast<int>(random.below(700));
    if (candidates->get(seed_x, 2)) seeds->set(seed_x, 2);
    expectSameAsPlain(*candidates, *seeds, 1000);
  }
}

/// One line that winds through the whole image, the hardest shape for sweeps over rows, from either
/// end: against the direction of the first sweep only the words next to a change are visited.
TEST(Hysteresis, FollowsASerpentine) {
  const int side = 257;
  for (const bool upright : {false, true}) {
    TestBits candidates(side, side);
    for (int major = 0; major < side; ++major) {
      for (int minor = 0; minor < side; ++minor) {
        const bool end = major / 2 % 2 == 0 ? minor == side - 1 : minor == 0;
        if (major % 2 == 1 && !end) continue;
        candidates->set(upright ? major : minor, upright ? minor : major);
      }
    }
    for (const int seed : {0, side - 1}) {
      TestBits edges(side, side);
      edges->set(seed, seed);
      grow(*candidates, *edges, 1 << 20);
      EXPECT_TRUE(std::ranges::equal(edges->words, candidates->words))
          << upright << " from " << seed;
    }
  }
}

TEST(Hysteresis, ExceedsItsBudgetByAtMostARow) {
  TestBits candidates(640, 300);
  for (std::uint64_t& word : candidates->words) word = ~std::uint64_t{0};
  TestBits edges(640, 300);
  edges->set(320, 299);
  // 300 rows of 10 words, at least two visits each, 40 + 10 words at most per step.
  EXPECT_GE(grow(*candidates, *edges, 40), 300 * 10 / 50);
  EXPECT_TRUE(std::ranges::equal(edges->words, candidates->words));
}

std::int32_t quantileOf(std::vector<std::int32_t> magnitudes, double share,
                        const std::vector<std::uint64_t>& ignored = {}) {
  TestArena arena;
  GradientHistogram histogram;
  histogram.begin(*arena);
  const auto width = static_cast<int>(magnitudes.size());
  magnitudes.resize((magnitudes.size() + 63) / 64 * 64);  // whole blocks, as of GradientRows
  histogram.addRow(magnitudes.data(), ignored.empty() ? nullptr : ignored.data(), width);
  return histogram.quantile(share);
}

TEST(GradientHistogram, Quantile_IsTheSmallestThresholdThatTheShareDoesNotExceed) {
  const std::vector<std::int32_t> magnitudes = {49, 1, 9, 25};
  EXPECT_EQ(quantileOf(magnitudes, 0.5), 3);
  EXPECT_EQ(quantileOf(magnitudes, 0.5 + 1e-9), 5);
  EXPECT_EQ(quantileOf(magnitudes, 0.75), 5);
  EXPECT_EQ(quantileOf(magnitudes, 0.76), 7);
  EXPECT_EQ(quantileOf({500, 600}, 0.9, {3}), 1443) << "without pixels, nothing exceeds it";
}

TEST(GradientHistogram, SquaredMagnitudesCountAsTheirRootRoundedUp) {
  for (std::int32_t root = 1; root <= 1442; ++root) {
    EXPECT_EQ(quantileOf({root * root - 1}, 0.9), root == 1 ? 0 : root);
    EXPECT_EQ(quantileOf({root * root}, 0.9), root);
    EXPECT_EQ(quantileOf({root * root + 1}, 0.9), root + 1);
  }
}

TEST(GradientHistogram, EqualsTheSortedMagnitudes) {
  Random random(81);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int32_t> magnitudes(1 + random.below(150));
    for (std::int32_t& magnitude : magnitudes) {
      const auto root = static_cast<std::int32_t>(random.below(1443));
      magnitude = root * root;
    }
    std::vector<std::uint64_t> ignored((magnitudes.size() + 63) / 64);
    std::vector<std::int32_t> kept;
    for (std::size_t i = 0; i < magnitudes.size(); ++i) {
      const bool ignore = round % 2 == 0 && random.below(3) == 0 && i != 0;
      if (ignore) ignored[i / 64] |= std::uint64_t{1} << (i % 64);
      if (!ignore)
        kept.push_back(static_cast<std::int32_t>(std::sqrt(static_cast<double>(magnitudes[i]))));
    }
    std::ranges::sort(kept);
    const double share = random.uniform(0.5, 1.0);
    std::size_t enough = 1;
    while (static_cast<double>(enough) < share * static_cast<double>(kept.size())) ++enough;
    EXPECT_EQ(quantileOf(magnitudes, share, ignored), kept[enough - 1]);
  }
}

}  // namespace
}  // namespace boresight
