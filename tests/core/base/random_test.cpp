// SPDX-License-Identifier: Apache-2.0
#include "core/base/random.h"

#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(Random, GivesThePublishedNumbers) {
  // Output of the generator's demonstration program for seed 42, stream 54.
  Random random(42, 54);
  for (const std::uint32_t expected :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    EXPECT_EQ(random.next(), expected);
}

TEST(Random, BelowIsUniform) {
  for (const std::uint32_t bound : {1u, 2u, 3u, 7u, 10u}) {
    Random random(99, bound);
    std::array<int, 10> counts{};
    constexpr int kDraws = 100000;
    for (int i = 0; i < kDraws; ++i) {
      const std::uint32_t value = random.below(bound);
      ASSERT_LT(value, bound);
      ++counts[value];
    }
    const double expected = static_cast<double>(kDraws) / bound;
    for (std::uint32_t value = 0; value < bound; ++value)
      EXPECT_NEAR(counts[value], expected, 5.0 * std::sqrt(expected) + 0.5);
  }
}

TEST(Random, BelowHasNoBiasForHugeBounds) {
  // With a plain remainder the lower half of 3 * 2^30 values would come twice as often.
  Random random(5);
  constexpr std::uint32_t kBound = 3u << 30;
  int low = 0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) low += random.below(kBound) < (1u << 30) ? 1 : 0;
  EXPECT_NEAR(low, kDraws / 3.0, 5.0 * std::sqrt(kDraws * 2.0 / 9.0));
  for (int i = 0; i < 1000; ++i) EXPECT_LT(random.below(0xffffffffu), 0xffffffffu);
}

TEST(Random, UniformFillsItsIntervalEvenly) {
  Random random(3);
  constexpr int kDraws = 200000;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  bool fine = false;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    sum += value;
    sum_of_squares += value * value;
    const double in_32_bits = value * 4294967296.0;
    fine = fine || in_32_bits != std::floor(in_32_bits);
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.004);
  EXPECT_NEAR(sum_of_squares / kDraws, 1.0 / 3.0, 0.004);
  EXPECT_TRUE(fine) << "53 bits, not 32";
}

TEST(Random, UniformNeverReachesItsOpenEnd) {
  Random random(4);
  const double next = std::nextafter(1.0, 2.0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(random.uniform(1.0, next), 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(-3.0, 5.0);
    EXPECT_GE(value, -3.0);
    EXPECT_LT(value, 5.0);
  }
}

TEST(Random, NormalHasTheMomentsAndTailsOfANormal) {
  Random random(8);
  constexpr int kDraws = 200000;
  std::array<double, 5> moment{};
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.normal();
    double power = 1.0;
    for (double& m : moment) m += (power *= value) / kDraws;
    beyond_two += std::abs(value) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(moment[0], 0.0, 0.012);
  EXPECT_NEAR(moment[1], 1.0, 0.016);
  EXPECT_NEAR(moment[2], 0.0, 0.05);
  EXPECT_NEAR(moment[3], 3.0, 0.12);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, std::erfc(std::sqrt(2.0)), 0.0025);
}

}  // namespace
}  // namespace boresight
