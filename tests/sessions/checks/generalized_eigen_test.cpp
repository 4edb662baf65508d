// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/generalized_eigen.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/geometry/pose.h"

namespace boresight::sessions {
namespace {

Matrix6d randomMatrix(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Matrix6d::NullaryExpr([&] { return normal(random); });
}

TEST(GeneralizedEigenTest, SolvesRandomPairs) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix6d root = randomMatrix(random);
    const Matrix6d other = randomMatrix(random);
    const Matrix6d a = other + other.transpose();
    const Matrix6d b = root * root.transpose() + 0.1 * Matrix6d::Identity();
    const auto eigen = generalizedEigen<6>(a, b);
    ASSERT_TRUE(eigen);
    for (int k = 0; k < 6; ++k) {
      const Vector6d x = eigen->vectors.col(k);
      EXPECT_LT((a * x - eigen->values[k] * b * x).norm(), 1e-9) << trial;
      EXPECT_NEAR(x.dot(b * x), 1.0, 1e-9);
      if (k > 0) {
        EXPECT_GE(eigen->values[k], eigen->values[k - 1]);
      }
    }
  }
}

TEST(GeneralizedEigenTest, RefusesWhatHasNoSolution) {
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d singular = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  EXPECT_FALSE(generalizedEigen<2>(one, singular));
  EXPECT_FALSE(generalizedEigen<2>(one, -one));
  Eigen::Matrix2d unknown = one;
  unknown(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(generalizedEigen<2>(unknown, one));
  EXPECT_FALSE(generalizedEigen<2>(one, unknown));
}

}  // namespace
}  // namespace boresight::sessions
