// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/binomial_bounds.h"

#include <cmath>

namespace boresight::sessions {
namespace {

/// P(X <= count) of a binomial variable: a sum of terms from logarithms, so that none underflows
/// before it is negligible.
double probabilityAtMost(std::int64_t count, std::int64_t runs, double share) {
  if (count >= runs || share <= 0.0) return 1.0;
  if (share >= 1.0) return 0.0;
  const double log_odds = std::log(share) - std::log1p(-share);
  double log_term = static_cast<double>(runs) * std::log1p(-share);
  double sum = std::exp(log_term);
  for (std::int64_t i = 1; i <= count; ++i) {
    log_term +=
        std::log(static_cast<double>(runs - i + 1)) - std::log(static_cast<double>(i)) + log_odds;
    sum += std::exp(log_term);
  }
  return sum;
}

}  // namespace

double upperBound(std::int64_t count, std::int64_t runs, double confidence) {
  if (count >= runs) return 1.0;
  double low = 0.0;
  double high = 1.0;
  // The probability falls with the share; 60 halvings exhaust a double.
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (probabilityAtMost(count, runs, middle) > 1.0 - confidence ? low : high) = middle;
  }
  return high;
}

double lowerBound(std::int64_t count, std::int64_t runs, double confidence) {
  return runs == 0 ? 0.0 : 1.0 - upperBound(runs - count, runs, confidence);
}

std::int64_t runsNeeded(double success, std::int64_t failures, double confidence) {
  const auto enough = [&](std::int64_t runs) {
    return probabilityAtMost(failures, runs, 1.0 - success) <= 1.0 - confidence;
  };
  std::int64_t high = failures + 1;
  while (!enough(high)) high *= 2;
  std::int64_t low = failures;  // never enough: all of them fail
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace boresight::sessions
