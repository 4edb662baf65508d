// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/binomial_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boresight::sessions {
namespace {

/// C(n, k) p^k (1 - p)^(n - k), factor by factor.
double term(int n, int k, double p) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value *= p * (n - k + i) / i;
  return value * std::pow(1.0 - p, n - k);
}

TEST(BinomialBounds, WithoutFailures_AreTheClosedFormAndWithoutRunsOpen) {
  for (const int runs : {1, 10, 62, 1000, 100000}) {
    EXPECT_NEAR(upperBound(0, runs), 1.0 - std::pow(0.05, 1.0 / runs), 1e-9) << runs;
    EXPECT_NEAR(lowerBound(runs, runs), std::pow(0.05, 1.0 / runs), 1e-9) << runs;
  }
  for (const int runs : {0, 7}) {
    EXPECT_EQ(upperBound(runs, runs), 1.0);
    EXPECT_EQ(lowerBound(0, runs), 0.0);
  }
}

TEST(BinomialBounds, AreWhereTheTailHasTheRestOfTheConfidence) {
  for (const int runs : {5, 20, 57})
    for (int count = 0; count < runs; ++count)
      for (const double confidence : {0.9, 0.95, 0.975}) {
        const double bound = upperBound(count, runs, confidence);
        double tail = 0.0;
        for (int i = 0; i <= count; ++i) tail += term(runs, i, bound);
        EXPECT_NEAR(tail, 1.0 - confidence, 1e-9) << count << " of " << runs;
        EXPECT_NEAR(lowerBound(runs - count, runs, confidence), 1.0 - bound, 1e-12);
      }
}

TEST(RunsNeeded, AreThoseOfAcceptanceSampling) {
  // The 95 % rows of sampling tables: 59 runs without failure show 95 %, 299 show 99 %.
  EXPECT_EQ(runsNeeded(0.95, 0), 59);
  EXPECT_EQ(runsNeeded(0.95, 1), 93);
  EXPECT_EQ(runsNeeded(0.99, 0), 299);
  EXPECT_EQ(runsNeeded(0.99, 1), 473);
  EXPECT_EQ(runsNeeded(0.999, 0), 2995);
}

TEST(RunsNeeded, AreTheFewestWhoseBoundReachesTheShare) {
  for (const double success : {0.5, 0.8, 0.97})
    for (const int failures : {0, 1, 4}) {
      const std::int64_t runs = runsNeeded(success, failures);
      EXPECT_GE(lowerBound(runs - failures, runs), success - 1e-12);
      EXPECT_LT(lowerBound(runs - 1 - failures, runs - 1), success);
    }
}

}  // namespace
}  // namespace boresight::sessions
