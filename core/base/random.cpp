// SPDX-License-Identifier: Apache-2.0
#include "core/base/random.h"

#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

// Rejection ends with a probability of at least 1/2 (below) or pi/4 (normal) per round; the bound
// is never met in practice (2^-64) and keeps every loop finite.
constexpr int kMostRounds = 64;

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : increment_((stream << 1) | 1u) {
  next();
  state_ += seed;
  next();
}

std::uint32_t Random::next() {
  const std::uint64_t state = state_;
  state_ = state * 6364136223846793005u + increment_;
  const auto shifted = static_cast<std::uint32_t>(((state >> 18) ^ state) >> 27);
  const auto rotation = static_cast<std::uint32_t>(state >> 59);
  return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
}

std::uint32_t Random::below(std::uint32_t bound) {
  if (bound <= 1) return 0;
  // 2^32 mod bound values exceed an even share; the lowest values are drawn again.
  const std::uint32_t surplus = (0 - bound) % bound;
  std::uint32_t value = next();
  for (int round = 1; value < surplus && round < kMostRounds; ++round) value = next();
  return value % bound;
}

double Random::uniform() {
  const std::uint32_t high = next() >> 5;
  const std::uint32_t low = next() >> 6;
  return (high * 67108864.0 + low) * (1.0 / 9007199254740992.0);
}

double Random::uniform(double low, double high) {
  const double value = low + (high - low) * uniform();
  return value < high ? value : low;  // rounding may reach the open end
}

double Random::normal() {
  // Marsaglia's polar method; the second variate is dropped so that the state stays one number.
  for (int round = 0; round < kMostRounds; ++round) {
    const double a = 2.0 * uniform() - 1.0;
    const double b = 2.0 * uniform() - 1.0;
    const double square = a * a + b * b;
    if (square < 1.0 && square > 0.0) return a * std::sqrt(-2.0 * log(square) / square);
  }
  return 0.0;
}

}  // namespace boresight
