// SPDX-License-Identifier: Apache-2.0
#include "core/base/math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/not_finite.h"

namespace boresight {
namespace {

using test::kInfinity;
using test::kNan;

constexpr long double kAllowed = 4e-16L;

/// Largest |actual - exact| / max(1, |exact|), exact in extended precision.
template <class Function, class Exact>
long double worstError(const std::vector<double>& arguments, Function function, Exact exact) {
  long double worst = 0.0L;
  for (const double x : arguments) {
    const long double expected = exact(static_cast<long double>(x));
    const long double error = std::abs(static_cast<long double>(function(x)) - expected) /
                              std::max(1.0L, std::abs(expected));
    EXPECT_FALSE(std::isnan(error)) << "at " << x;
    worst = std::max(worst, error);
  }
  return worst;
}

/// A dense grid, random arguments, arguments of every magnitude, and both ends.
std::vector<double> argumentsBetween(double low, double high) {
  Random random(7);
  std::vector<double> arguments = {low, high};
  for (int i = 0; i <= 100000; ++i) arguments.push_back(low + (high - low) * i / 100000.0);
  for (int i = 0; i < 100000; ++i) arguments.push_back(random.uniform(low, high));
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10.0, random.uniform(-300.0, 2.0));
    for (const double x : {size, -size})
      if (x >= low && x <= high) arguments.push_back(x);
  }
  return arguments;
}

/// Neighbourhoods of the multiples of pi / 4, where range reduction loses digits if it can.
std::vector<double> nearMultiplesOfQuarterPi() {
  std::vector<double> arguments;
  for (int k = -127; k <= 127; ++k) {
    double x = k * (kPi / 4.0);
    for (int i = 0; i < 20; ++i) x = std::nextafter(x, -1e3);
    for (int i = 0; i < 40; ++i) {
      arguments.push_back(x);
      x = std::nextafter(x, 1e3);
    }
  }
  return arguments;
}

TEST(Trigonometry, SineAndCosineAreAccurate) {
  for (const auto& arguments : {argumentsBetween(-100.0, 100.0), nearMultiplesOfQuarterPi()}) {
    EXPECT_LT(worstError(arguments, sin, [](long double x) { return std::sin(x); }), kAllowed);
    EXPECT_LT(worstError(arguments, cos, [](long double x) { return std::cos(x); }), kAllowed);
  }
}

TEST(Trigonometry, SineKeepsRelativeAccuracyNextToItsZeros) {
  for (const double x : nearMultiplesOfQuarterPi()) {
    const long double expected = std::sin(static_cast<long double>(x));
    // Extended precision itself resolves sin(x) next to k pi to about 1e-19 |x|.
    const long double tolerance = 4e-16L * std::abs(expected) + 1e-18L;
    EXPECT_LE(std::abs(sin(x) - expected), tolerance) << x;
  }
}

TEST(Trigonometry, TangentIsAccurateAwayFromItsPoles) {
  std::vector<double> arguments = argumentsBetween(-100.0, 100.0);
  std::erase_if(arguments, [](double x) { return std::abs(std::cos(x)) < 1e-3; });
  EXPECT_LT(worstError(arguments, tan, [](long double x) { return std::tan(x); }), kAllowed);
}

TEST(Trigonometry, StaysInRangeForHugeArguments) {
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::pow(10.0, random.uniform(2.0, 308.0)) * (i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_LE(std::abs(sin(x)), 1.0) << x;
    EXPECT_LE(std::abs(cos(x)), 1.0) << x;
    if (std::abs(x) < 1e6) {
      EXPECT_NEAR(sin(x), std::sin(x), 4e-16);
      EXPECT_NEAR(cos(x), std::cos(x), 4e-16);
    }
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_TRUE(std::isnan(sin(bad)));
    EXPECT_TRUE(std::isnan(cos(bad)));
    EXPECT_TRUE(std::isnan(tan(bad)));
  }
}

TEST(Trigonometry, KnowsExactValues) {
  EXPECT_EQ(sin(0.0), 0.0);
  EXPECT_EQ(cos(0.0), 1.0);
  EXPECT_EQ(tan(0.0), 0.0);
  EXPECT_EQ(sin(kPi / 2.0), 1.0);
  EXPECT_EQ(cos(kPi), -1.0);
  EXPECT_EQ(sin(1e-300), 1e-300);
  EXPECT_EQ(atan(1.0), kPi / 4.0);
  EXPECT_EQ(atan(1e-300), 1e-300);
}

TEST(ArcTangent, IsAccurateEverywhere) {
  std::vector<double> arguments = argumentsBetween(-5.0, 5.0);
  Random random(13);
  for (int i = 0; i < 50000; ++i)
    arguments.push_back(std::pow(10.0, random.uniform(-300.0, 300.0)) * (i % 2 == 0 ? 1 : -1));
  for (int k = 0; k <= 16; ++k)  // where the table changes its entry
    for (const double x : {k / 16.0, std::nextafter(k / 16.0, 2.0), std::nextafter(k / 16.0, -1.0)})
      arguments.push_back(x);
  arguments.insert(arguments.end(), {kInfinity, -kInfinity});
  EXPECT_LT(worstError(arguments, atan, [](long double x) { return std::atan(x); }), kAllowed);
  EXPECT_TRUE(std::isnan(atan(kNan)));
}

TEST(ArcTangent, KeepsRelativeAccuracyForSmallArguments) {
  Random random(17);
  for (int i = 0; i < 50000; ++i) {
    const double x = std::pow(10.0, random.uniform(-300.0, -1.3));
    const long double expected = std::atan(static_cast<long double>(x));
    EXPECT_LE(std::abs(atan(x) - expected), 3e-16L * expected) << x;
  }
}

TEST(ArcTangent2, IsAccurateInAllDirections) {
  Random random(19);
  long double worst = 0.0L;
  for (int i = 0; i < 200000; ++i) {
    const double size = std::pow(10.0, random.uniform(-150.0, 150.0));
    const double x = size * random.uniform(-1.0, 1.0);
    const double y = size * random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-20.0, 0.0));
    const long double expected =
        std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, std::abs(atan2(y, x) - expected) / std::max(1.0L, std::abs(expected)));
  }
  EXPECT_LT(worst, kAllowed);
}

TEST(ArcTangent2, KnowsTheAxesAndTheDiagonals) {
  EXPECT_EQ(atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(atan2(0.0, 2.0), 0.0);
  EXPECT_EQ(atan2(0.0, -2.0), kPi);
  EXPECT_EQ(atan2(-0.0, -2.0), kPi);
  EXPECT_EQ(atan2(3.0, 0.0), kPi / 2.0);
  EXPECT_EQ(atan2(-3.0, 0.0), -kPi / 2.0);
  EXPECT_EQ(atan2(2.0, 2.0), kPi / 4.0);
  EXPECT_EQ(atan2(2.0, -2.0), 3.0 * kPi / 4.0);
  EXPECT_EQ(atan2(-2.0, -2.0), -3.0 * kPi / 4.0);
  EXPECT_EQ(atan2(kInfinity, kInfinity), kPi / 4.0);
  EXPECT_EQ(atan2(-kInfinity, 1.0), -kPi / 2.0);
  EXPECT_EQ(atan2(1.0, -kInfinity), kPi);
  EXPECT_TRUE(std::isnan(atan2(kNan, 1.0)));
  EXPECT_TRUE(std::isnan(atan2(1.0, kNan)));
}

TEST(ArcSine, IsAccurateAndClamped) {
  std::vector<double> arguments = argumentsBetween(-1.0, 1.0);
  for (double x = 1.0, step = 0.1; step > 1e-17; step *= 0.7) {
    arguments.push_back(x - step);
    arguments.push_back(step - x);
  }
  EXPECT_LT(worstError(arguments, asin, [](long double x) { return std::asin(x); }), kAllowed);
  EXPECT_EQ(asin(1.5), kPi / 2.0);
  EXPECT_EQ(asin(-kInfinity), -kPi / 2.0);
  EXPECT_TRUE(std::isnan(asin(kNan)));
}

TEST(Exponential, IsAccurateFromUnderflowToOverflow) {
  const auto exact = [](long double x) { return std::exp(x); };
  EXPECT_LT(worstError(argumentsBetween(-5.0, 5.0), exp, exact), kAllowed);
  EXPECT_LT(worstError(argumentsBetween(-745.0, 709.7), exp, exact), kAllowed);
  EXPECT_EQ(exp(0.0), 1.0);
  EXPECT_EQ(exp(-1e9), 0.0);
  EXPECT_EQ(exp(-kInfinity), 0.0);
  EXPECT_EQ(exp(1e9), kInfinity);
  EXPECT_EQ(exp(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(exp(kNan)));
  for (const double x : {-708.0, -710.0, -740.0, -745.1})  // subnormal results
    EXPECT_NEAR(exp(x), std::exp(x), 5e-324 + 4e-16 * std::exp(x)) << x;
}

TEST(NaturalLogarithm, IsAccurateForEveryPositiveNumber) {
  const auto exact = [](long double x) { return std::log(x); };
  std::vector<double> arguments = argumentsBetween(1e-3, 50.0);
  Random random(23);
  for (int i = 0; i < 50000; ++i)
    arguments.push_back(std::pow(10.0, random.uniform(-323.0, 308.0)));
  arguments.insert(arguments.end(),
                   {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()});
  EXPECT_LT(worstError(arguments, log, exact), kAllowed);
  for (int i = 1; i < 1000; ++i) {  // next to 1 the logarithm is small and keeps its digits
    const double x = 1.0 + i * 1e-12;
    const long double expected = std::log(static_cast<long double>(x));
    EXPECT_LE(std::abs(log(x) - expected), 3e-16L * expected);
  }
  EXPECT_EQ(log(1.0), 0.0);
  EXPECT_EQ(log(0.0), -1e308);
  EXPECT_EQ(log(-3.0), -1e308);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(log(kNan)));
}

TEST(IsFinite, KnowsInfinitiesAndNans) {
  for (const double finite :
       {0.0, std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min()})
    EXPECT_TRUE(isFinite(finite)) << finite;
  for (const double bad : {kInfinity, -kInfinity, kNan}) EXPECT_FALSE(isFinite(bad)) << bad;
}

}  // namespace
}  // namespace boresight
