// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polynomial.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

TEST(Polynomial, EvaluatesMultipliesAndDifferentiates) {
  const Polynomial a{{1.0, 2.0, 3.0}};
  const Polynomial b{{-1.0, 0.0, 0.0, 4.0}};
  for (const double x : {-1.5, 0.0, 0.3, 2.0}) {
    const double at_a = 1.0 + 2.0 * x + 3.0 * x * x;
    const double at_b = -1.0 + 4.0 * x * x * x;
    EXPECT_NEAR(a(x), at_a, 1e-12);
    EXPECT_NEAR((a * b)(x), at_a * at_b, 1e-10);
    EXPECT_NEAR((a + 2.5 * b)(x), at_a + 2.5 * at_b, 1e-11);
    EXPECT_NEAR(b.derivative()(x), 12.0 * x * x, 1e-11);
  }
}

TEST(PositiveUpTo, FindsTheFirstOfManyRoots) {
  Random random = randomFor("FindsTheFirstOfManyRoots");
  for (int i = 0; i < 500; ++i) {
    Polynomial polynomial{{1.0}};
    double first = 10.0;
    const int roots = static_cast<int>(random.below(6));
    for (int k = 0; k < roots; ++k) {
      const double root = random.uniform(0.05, 5.0);
      first = std::min(first, root);
      polynomial = polynomial * Polynomial{{1.0, -1.0 / root}};
      // A pair of complex roots: bends without reaching zero.
      const double centre = random.uniform(0.1, 5.0);
      polynomial = polynomial * Polynomial{{centre * centre + 0.5, -2.0 * centre, 1.0}};
    }
    // Roots that nearly coincide lose digits; with neighbours far apart all remain.
    EXPECT_NEAR(positiveUpTo(polynomial, 10.0), first, 1e-5 * first) << i;
  }
}

TEST(PositiveUpTo, SeesTwoRootsThatAreCloseTogether) {
  // (x - 1) (x - 1.0001): negative on a ten-thousandth only.
  const Polynomial dip{{1.0001, -2.0001, 1.0}};
  EXPECT_NEAR(positiveUpTo(dip, 100.0), 1.0, 1e-9);
}

TEST(PositiveUpTo, NeverReturnsAPointThatIsNotPositive) {
  Random random = randomFor("NeverReturnsAPointThatIsNotPositive");
  for (int i = 0; i < 500; ++i) {
    Polynomial polynomial{{1.0}};
    for (std::size_t k = 1; k < 14; ++k) polynomial.c[k] = random.uniform(-1.0, 1.0);
    const double end = positiveUpTo(polynomial, 1e4);
    EXPECT_GT(polynomial(end), 0.0);
    if (end < 1e4) {
      EXPECT_LE(polynomial(std::nextafter(end, 1e5)), 0.0);
    }
    for (int j = 0; j < 200; ++j) EXPECT_GT(polynomial(random.uniform(0.0, end)), 0.0);
  }
}

TEST(PositiveUpTo, IsTheLimitWithoutRootsAndZeroWithoutAStart) {
  EXPECT_EQ(positiveUpTo({{1.0}}, 7.0), 7.0);
  EXPECT_EQ(positiveUpTo({{1.0, 0.0, 3.0}}, 7.0), 7.0);
  EXPECT_EQ(positiveUpTo({{1.0, -0.1}}, 7.0), 7.0);  // its root is beyond
  EXPECT_EQ(positiveUpTo({{0.0, 1.0}}, 7.0), 0.0);
  EXPECT_EQ(positiveUpTo({{-1.0, 5.0}}, 7.0), 0.0);
}

}  // namespace
}  // namespace boresight::test
