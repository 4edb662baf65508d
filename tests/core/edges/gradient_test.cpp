// SPDX-License-Identifier: Apache-2.0
#include "core/edges/gradient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/core/edges/test_images.h"

namespace boresight {
namespace {

/// Magnitudes as GradientRows gives them: padded to whole blocks, squared.
std::vector<std::int32_t> rowOf(const std::vector<std::int32_t>& magnitudes) {
  std::vector<std::int32_t> row = magnitudes;
  row.resize((row.size() + 63) / 64 * 64);
  return row;
}

std::int32_t quantileOf(const std::vector<std::int32_t>& magnitudes, double share,
                        const std::vector<std::uint64_t>& ignored = {}) {
  TestArena arena;
  GradientHistogram histogram;
  histogram.begin(*arena);
  histogram.addRow(rowOf(magnitudes).data(), ignored.empty() ? nullptr : ignored.data(),
                   static_cast<int>(magnitudes.size()));
  return histogram.quantile(share);
}

TEST(GradientHistogram, QuantileIsTheSmallestThatEnoughDoNotExceed) {
  const std::vector<std::int32_t> magnitudes = {49, 1, 9, 25};
  EXPECT_EQ(quantileOf(magnitudes, 0.5), 3);
  EXPECT_EQ(quantileOf(magnitudes, 0.5 + 1e-9), 5);
  EXPECT_EQ(quantileOf(magnitudes, 0.75), 5);
  EXPECT_EQ(quantileOf(magnitudes, 0.76), 7);
}

TEST(GradientHistogram, SquaredMagnitudesCountAsTheirRootRoundedUp) {
  EXPECT_EQ(quantileOf({0}, 0.9), 0);
  EXPECT_EQ(quantileOf({1}, 0.9), 1);
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

TEST(GradientHistogram, WithoutPixelsNothingExceedsTheQuantile) {
  EXPECT_EQ(quantileOf({500, 600}, 0.9, {3}), 1443);
}

}  // namespace
}  // namespace boresight
