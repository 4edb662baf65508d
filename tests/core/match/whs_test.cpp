// SPDX-License-Identifier: Apache-2.0
#include "core/match/whs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/match/search_problem.h"

namespace boresight::test {
namespace {

TEST(WhsCountsAt, EqualsTheDefinition) {
  Dice dice;
  for (int trial = 0; trial < 300; ++trial) {
    const int side = 2 * dice.between(1, 80), half = side / 2;
    const OwnedBits edges = noise(side + 70, side + 5, dice.uniform(0.0, 0.5), dice);
    const OwnedBits mask = noise(side + 70, side + 5, dice.uniform(), dice);
    const OwnedBits test = noise(side + 90, side + 3, dice.uniform(0.0, 0.5), dice);
    const TemplateView view{&edges.image, &mask.image, dice.between(half, edges.image.width - half),
                            dice.between(half, edges.image.height - half), side};
    const int x = dice.between(half, test.image.width - half);
    const int y = dice.between(half, test.image.height - half);
    ASSERT_EQ(whsCountsAt(view, test.image, x, y), whsCountsReference(view, test.image, x, y));
    ASSERT_EQ(whsNorms(view), whsNormsReference(view));
  }
}

TEST(WhsCountsAt, CountsNothingOutside) {
  Dice dice;
  const OwnedBits bits = noise(64, 64, 0.5, dice);
  const TemplateView view{&bits.image, &bits.image, 32, 32, 32};
  EXPECT_NE(whsCountsAt(view, bits.image, 16, 48), WhsCounts{});
  EXPECT_EQ(whsCountsAt(view, bits.image, 15, 48), WhsCounts{});
  EXPECT_EQ(whsCountsAt(view, bits.image, 16, 49), WhsCounts{});
  EXPECT_EQ(whsNorms({&bits.image, &bits.image, 15, 32, 32}), WhsNorms{});
  EXPECT_EQ(whsNorms({nullptr, &bits.image, 32, 32, 32}), WhsNorms{});
}

TEST(WhsScore, AddsTheSharesAndIsZeroWithoutPixels) {
  EXPECT_DOUBLE_EQ(whsScore({3, 10}, {4, 20}), 0.75 + 0.5);
  EXPECT_DOUBLE_EQ(whsScore({4, 20}, {4, 20}), 2.0);
  EXPECT_DOUBLE_EQ(whsScore({0, 5}, {0, 20}), 0.25);
  EXPECT_DOUBLE_EQ(whsScore({1, 0}, {4, 0}), 0.25);
  EXPECT_DOUBLE_EQ(whsScore({0, 0}, {0, 0}), 0.0);
}

TEST(WhsComparable, OrdersAsTheScore) {
  Dice dice;
  for (int trial = 0; trial < 1000; ++trial) {
    const WhsNorms norms{dice.between(0, 3) == 0 ? 0 : dice.between(1, 3000),
                         dice.between(0, 3) == 0 ? 0 : dice.between(1, 60000)};
    const WhsCounts a{dice.between(0, norms.edges), dice.between(0, norms.empties)};
    const WhsCounts b{dice.between(0, norms.edges), dice.between(0, norms.empties)};
    const double difference = whsScore(a, norms) - whsScore(b, norms);
    if (std::abs(difference) < 1e-12) continue;
    EXPECT_EQ(difference > 0.0, whsComparable(a, norms) > whsComparable(b, norms));
  }
}

TEST(WhsScoreMap, EqualsTheCountsAtEveryOffsetAndStopsWhereTheMapEnds) {
  Dice dice;
  const OwnedBits edges = noise(100, 90, 0.1, dice);
  const OwnedBits mask = noise(100, 90, 0.7, dice);
  const OwnedBits test = noise(150, 120, 0.1, dice);
  const TemplateView view{&edges.image, &mask.image, 41, 50, 40};
  const SearchWindow window{20, 31, 110, 77};
  std::vector<WhsCounts> map(static_cast<std::size_t>(window.width() * window.height()));
  whsScoreMap(view, test.image, window, map);
  std::size_t next = 0;
  for (int y = window.y_min; y <= window.y_max; ++y) {
    for (int x = window.x_min; x <= window.x_max; ++x) {
      ASSERT_EQ(map[next++], whsCountsAt(view, test.image, x, y));
    }
  }
  std::vector<WhsCounts> beginning(5);
  whsScoreMap(view, test.image, window, beginning);
  whsScoreMap(view, test.image, SearchWindow{}, beginning);
  EXPECT_TRUE(std::equal(beginning.begin(), beginning.end(), map.begin()));
}

/// Edge pixels within half a pixel of a circle whose centre is displaced by (dx, dy).
OwnedBits circle(double dx, double dy, double half_width) {
  return drawn(128, 128, [=](int x, int y) {
    return std::abs(std::hypot(x - 64.0 - dx, y - 64.0 - dy) - 30.0) <= half_width;
  });
}

TEST(SubpixelPeak, FollowsDisplacedEdges) {
  for (const double dx : {-0.4, -0.25, 0.0, 0.25, 0.4}) {
    for (const double dy : {-0.3, 0.0, 0.45}) {
      Problem problem(circle(0.0, 0.0, 1.0), fullMask(128), circle(3.0 + dx, -2.0 + dy, 1.0), 80);
      problem.moveTemplate(64, 64);
      problem.window = {60, 60, 70, 66};
      const WhsPeak peak = reference(problem);
      EXPECT_EQ(peak.x, 67);
      EXPECT_EQ(peak.y, 62);
      double x = 0.0, y = 0.0;
      subpixelPeak(problem.view, problem.test.image, peak, x, y);
      EXPECT_NEAR(x, 67.0 + dx, 0.15);
      EXPECT_NEAR(y, 62.0 + dy, 0.15);
    }
  }
}

/// Top of the parabola through the scores at -1, 0, 1, as the definition has it.
double topThrough(std::int64_t left, std::int64_t middle, std::int64_t right) {
  const std::int64_t curvature = left - 2 * middle + right;
  if (curvature >= 0) return 0.0;
  return std::clamp(0.5 * static_cast<double>(left - right) / static_cast<double>(curvature), -0.5,
                    0.5);
}

TEST(SubpixelPeak, EqualsTheDefinitionForRandomInput) {
  Dice dice;
  for (int trial = 0; trial < 200; ++trial) {
    const int side = 2 * dice.between(1, trial % 10 == 0 ? 256 : 70), half = side / 2;
    const OwnedBits bits = noise(side + 9, side + 5, 0.2, dice);
    const OwnedBits mask = noise(side + 9, side + 5, dice.uniform(), dice);
    const OwnedBits test = noise(side + dice.below(70), side + dice.below(4), 0.3, dice);
    const TemplateView view{&bits.image, &mask.image, half + dice.below(9), half + dice.below(5),
                            side};
    WhsPeak peak;
    peak.x = dice.between(half, test.image.width - half);
    peak.y = dice.between(half, test.image.height - half);
    const WhsNorms norms = whsNormsReference(view);
    const auto value = [&](int x, int y) {
      return whsComparable(whsCountsReference(view, test.image, x, y), norms);
    };
    const auto inside = [&](int x, int y) {
      return x >= half && y >= half && x <= test.image.width - half &&
             y <= test.image.height - half;
    };
    const auto refined = [&](int dx, int dy) {
      const int before_x = peak.x - dx, before_y = peak.y - dy;
      const int after_x = peak.x + dx, after_y = peak.y + dy;
      if (!inside(before_x, before_y) || !inside(after_x, after_y)) return 0.0;
      return topThrough(value(before_x, before_y), value(peak.x, peak.y), value(after_x, after_y));
    };
    double x = 0.0, y = 0.0;
    subpixelPeak(view, test.image, peak, x, y);
    ASSERT_EQ(x, peak.x + refined(1, 0)) << "trial " << trial << " side " << side;
    ASSERT_EQ(y, peak.y + refined(0, 1)) << "trial " << trial << " side " << side;
  }
}

}  // namespace
}  // namespace boresight::test
