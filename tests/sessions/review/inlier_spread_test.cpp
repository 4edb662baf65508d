// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/inlier_spread.h"

#include <gtest/gtest.h>

#include <vector>

namespace boresight::sessions {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// A grid of 11 x 11 points over `width` x `height` px, turned by 30 deg.
Points grid(double width, double height) {
  Points points;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j) {
      const Eigen::Vector2d flat(width * (i / 10.0 - 0.5), height * (j / 10.0 - 0.5));
      points.emplace_back(0.866 * flat.x() - 0.5 * flat.y() + 100.0,
                          0.5 * flat.x() + 0.866 * flat.y() + 50.0);
    }
  return points;
}

TEST(InlierSpread, OfPointsThatLieLikeTheOthersIsOne) {
  EXPECT_NEAR(leastSpread(grid(200, 100), grid(200, 100), 1.0).value(), 1.0, 1e-9);
}

TEST(InlierSpread, IsTheLeastOverAllDirections) {
  // Half as wide one way, as wide the other: neither axis is one of the image's.
  EXPECT_NEAR(leastSpread(grid(100, 100), grid(200, 100), 0.0).value(), 0.5, 1e-3);
  EXPECT_NEAR(leastSpread(grid(200, 30), grid(200, 100), 0.0).value(), 0.3, 1e-3);
}

TEST(InlierSpread, OfPointsOnALineAcrossAnAreaIsNearlyNothing) {
  EXPECT_LT(leastSpread(grid(200, 0), grid(200, 100), 1.0).value(), 0.05);
}

TEST(InlierSpread, OthersOnALineAskForNoSpreadAcrossIt) {
  EXPECT_GT(leastSpread(grid(200, 0), grid(200, 0.5), 1.0).value(), 0.9);
}

TEST(InlierSpread, NeedsPoints) {
  EXPECT_FALSE(leastSpread(Points{{1.0, 2.0}}, grid(10, 10), 1.0));
  EXPECT_FALSE(leastSpread(grid(10, 10), Points(), 1.0));
}

TEST(InlierSpread, DeviationAndMedian) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(medianOf(values), 2.0);
  EXPECT_NEAR(deviationOf(values), 1.118033988749895, 1e-12);
  EXPECT_EQ(deviationOf(std::vector<double>{7.0}), 0.0);
}

}  // namespace
}  // namespace boresight::sessions
