// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight {

/// The root of a function that increases in [low, high]: Newton's method from `start`, bisection
/// where a step leaves the bounds. The slope may be zero at a bound.
template <class Value, class Slope>
double rootBetween(double low, double high, double start, const Value& value, const Slope& slope) {
  constexpr int kMostRounds = 100;
  double x = start;
  for (int round = 0; round < kMostRounds; ++round) {
    const double excess = value(x);
    if (excess == 0.0) break;
    (excess > 0.0 ? high : low) = x;
    const double newton = x - excess / slope(x);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == x || next <= low || next >= high) break;
    x = next;
  }
  return x;
}

}  // namespace boresight
