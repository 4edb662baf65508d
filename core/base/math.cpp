// SPDX-License-Identifier: Apache-2.0
#include "core/base/math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr double kHalfPi = 0x1.921fb54442d18p+0;
constexpr double kHalfPiTail = 0x1.1a62633145c07p-54;  // pi / 2 - kHalfPi

/// c[0] + c[1] x + ..., by Horner.
double polynomial(std::span<const double> coefficients, double x) {
  double sum = 0.0;
  for (std::size_t i = coefficients.size(); i > 0; --i) sum = sum * x + coefficients[i - 1];
  return sum;
}

/// x = (4 m + quadrant) pi / 2 + high + low with |high| <= pi / 4 (low below an ulp of high).
struct ReducedAngle {
  double high;
  double low;
  int quadrant;
};

/// Cody and Waite: pi / 2 in three parts, the first two of 33 bits, so that their products with a
/// count below 2^20 are exact. Beyond that the angle loses accuracy but stays in range.
ReducedAngle reduceAngle(double x_rad) {
  constexpr double kFirst = 0x1.921fb544p+0;
  constexpr double kSecond = 0x1.0b4611a6p-34;
  constexpr double kThird = 0x1.3198a2e037073p-69;
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  if (!isFinite(x_rad)) return {std::numeric_limits<double>::quiet_NaN(), 0.0, 0};

  const double count = std::floor(x_rad * kTwoOverPi + 0.5);
  const double first = x_rad - count * kFirst;
  const double part = -count * kSecond;
  const double sum = first + part;
  const double part_kept = sum - first;
  const double lost = (first - (sum - part_kept)) + (part - part_kept);
  const double tail = lost - count * kThird;

  ReducedAngle angle{};
  angle.high = sum + tail;
  angle.low = (sum - angle.high) + tail;
  if (!(angle.high >= -0.8 && angle.high <= 0.8)) angle = {0.0, 0.0, 0};  // |x| far beyond 2^20
  angle.quadrant = static_cast<int>(count - 4.0 * std::floor(count * 0.25)) & 3;
  return angle;
}

/// Taylor series about 0: on |x| <= pi / 4 the first term left out is below 1e-19.
double sinOfReduced(const ReducedAngle& angle) {
  static constexpr std::array<double, 8> kTerms = {
      -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,
      -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
  const double x = angle.high;
  const double square = x * x;
  return x + (x * square * polynomial(kTerms, square) + angle.low * (1.0 - 0.5 * square));
}

double cosOfReduced(const ReducedAngle& angle) {
  static constexpr std::array<double, 8> kTerms = {
      1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,          -1.0 / 3628800.0,
      1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};
  const double x = angle.high;
  const double square = x * x;
  const double half = 0.5 * square;
  const double front = 1.0 - half;
  const double front_error = (1.0 - front) - half;
  return front + (front_error + (square * square * polynomial(kTerms, square) - x * angle.low));
}

/// atan(x) for 0 <= x <= 1: addition theorem about the nearest k / 8, then Taylor on |t| <= 1 / 16.
double atanOfFraction(double x) {
  struct Value {
    double high;
    double low;
  };
  static constexpr std::array<Value, 9> kAtanOfEighths = {
      {{0.0, 0.0},
       {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
       {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
       {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
       {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
       {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
       {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
       {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
       {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
  static constexpr std::array<double, 6> kTerms = {-1.0 / 3.0, 1.0 / 5.0,   -1.0 / 7.0,
                                                   1.0 / 9.0,  -1.0 / 11.0, 1.0 / 13.0};
  const int eighths = static_cast<int>(std::floor(x * 8.0 + 0.5));
  const double knot = 0.125 * eighths;
  const double t = (x - knot) / (1.0 + x * knot);
  const double square = t * t;
  const Value& value = nth(kAtanOfEighths, eighths);
  return value.high + (t + (t * square * polynomial(kTerms, square) + value.low));
}

/// 2^exponent for -1022 <= exponent <= 1023.
double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

constexpr double kLog2High = 0x1.62e42fefp-1;       // 33 bits: its products with exponents
constexpr double kLog2Low = 0x1.473de6af278edp-34;  // are exact
constexpr double kOneOverLog2 = 0x1.71547652b82fep+0;

}  // namespace

double sin(double x_rad) {
  const ReducedAngle angle = reduceAngle(x_rad);
  const double value = (angle.quadrant & 1) != 0 ? cosOfReduced(angle) : sinOfReduced(angle);
  return (angle.quadrant & 2) != 0 ? -value : value;
}

double cos(double x_rad) {
  const ReducedAngle angle = reduceAngle(x_rad);
  const double value = (angle.quadrant & 1) != 0 ? sinOfReduced(angle) : cosOfReduced(angle);
  return angle.quadrant == 1 || angle.quadrant == 2 ? -value : value;
}

double tan(double x_rad) {
  const ReducedAngle angle = reduceAngle(x_rad);
  const double sin_value = sinOfReduced(angle);
  const double cos_value = cosOfReduced(angle);
  return (angle.quadrant & 1) != 0 ? -cos_value / sin_value : sin_value / cos_value;
}

double atan(double x) {
  if (x != x) return x;
  const double magnitude = x < 0.0 ? -x : x;
  const double value = magnitude <= 1.0 ? atanOfFraction(magnitude)
                                        : kHalfPi - (atanOfFraction(1.0 / magnitude) - kHalfPiTail);
  return x < 0.0 ? -value : value;
}

double atan2(double y, double x) {
  if (x != x || y != y) return std::numeric_limits<double>::quiet_NaN();
  const double x_size = x < 0.0 ? -x : x;
  const double y_size = y < 0.0 ? -y : y;
  if (x_size == 0.0 && y_size == 0.0) return 0.0;
  // The angle in the octant next to the x axis, from the quotient of the smaller by the larger
  // (equal infinities included), then mirrored at the diagonal, the y axis and the x axis.
  double angle = 0.0;
  if (x_size == y_size) {
    angle = 0.5 * kHalfPi;
  } else if (y_size < x_size) {
    angle = atanOfFraction(y_size / x_size);
  } else {
    angle = kHalfPi - (atanOfFraction(x_size / y_size) - kHalfPiTail);
  }
  if (x < 0.0) angle = 2.0 * kHalfPi - (angle - 2.0 * kHalfPiTail);
  return y < 0.0 ? -angle : angle;
}

double asin(double x) {
  if (x >= 1.0) return kHalfPi;
  if (x <= -1.0) return -kHalfPi;
  return atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

double exp(double x) {
  if (x != x) return x;
  if (x > 709.8) return std::numeric_limits<double>::infinity();
  if (x < -745.2) return 0.0;
  static constexpr std::array<double, 12> kTerms = {
      1.0 / 2.0,       1.0 / 6.0,        1.0 / 24.0,        1.0 / 120.0,
      1.0 / 720.0,     1.0 / 5040.0,     1.0 / 40320.0,     1.0 / 362880.0,
      1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
  const double count = std::floor(x * kOneOverLog2 + 0.5);
  const double rest = (x - count * kLog2High) - count * kLog2Low;
  const double value = 1.0 + (rest + rest * rest * polynomial(kTerms, rest));
  // In two steps: 2^count itself may be beyond the range while the product is not.
  const int exponent = static_cast<int>(count);
  const int half = exponent / 2;
  return value * powerOfTwo(half) * powerOfTwo(exponent - half);
}

double log(double x) {
  if (x != x) return x;
  if (x <= 0.0) return -1e308;
  if (x > std::numeric_limits<double>::max()) return x;
  int exponent = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= powerOfTwo(54);
    exponent = -54;
  }
  // x = 2^exponent (1 + f) with 1 + f between sqrt(1/2) and sqrt(2); log(1 + f) = 2 artanh(s).
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> 52) - 1023;
  double significand = std::bit_cast<double>((bits & kFraction) | (std::uint64_t{1023} << 52));
  if (significand > 0x1.6a09e667f3bcdp+0) {
    significand *= 0.5;
    ++exponent;
  }
  static constexpr std::array<double, 11> kTerms = {2.0 / 3.0,  2.0 / 5.0,  2.0 / 7.0,  2.0 / 9.0,
                                                    2.0 / 11.0, 2.0 / 13.0, 2.0 / 15.0, 2.0 / 17.0,
                                                    2.0 / 19.0, 2.0 / 21.0, 2.0 / 23.0};
  const double f = significand - 1.0;
  const double s = f / (2.0 + f);
  const double square = s * s;
  const double remainder = s * square * polynomial(kTerms, square);
  const double count = exponent;
  // 2 s = f - s f keeps the exact f in front.
  return count * kLog2High + (f - (s * f - (remainder + count * kLog2Low)));
}

}  // namespace boresight
