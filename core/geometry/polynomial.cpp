// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polynomial.h"

namespace boresight {
namespace {

/// Halvings from the widest interval down to neighbouring doubles.
constexpr int kBisectionRounds = 100;

struct Roots {
  std::array<double, Polynomial::kTerms + 1> at{};
  std::size_t count = 0;
};

/// The end of [low, high] before the change of sign, as close to it as doubles allow.
double bisect(const Polynomial& polynomial, double low, double high) {
  const bool sign_low = polynomial(low) > 0.0;
  for (int round = 0; round < kBisectionRounds; ++round) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((polynomial(middle) > 0.0) == sign_low ? low : high) = middle;
  }
  return low;
}

/// Roots with a change of sign in (0, limit), ascending, given those of the derivative.
Roots rootsBetween(const Polynomial& polynomial, const Roots& critical, double limit) {
  Roots roots;
  double low = 0.0;
  for (std::size_t i = 0; i <= critical.count; ++i) {
    const double high = i < critical.count ? critical.at[i] : limit;
    if ((polynomial(low) > 0.0) != (polynomial(high) > 0.0) && roots.count < Polynomial::kTerms)
      roots.at[roots.count++] = bisect(polynomial, low, high);
    low = high;
  }
  return roots;
}

}  // namespace

double Polynomial::operator()(double x) const {
  double sum = 0.0;
  for (std::size_t i = kTerms; i > 0; --i) sum = sum * x + c[i - 1];
  return sum;
}

Polynomial Polynomial::derivative() const {
  Polynomial result;
  for (std::size_t i = 1; i < kTerms; ++i) result.c[i - 1] = static_cast<double>(i) * c[i];
  return result;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (std::size_t i = 0; i < Polynomial::kTerms; ++i)
    for (std::size_t j = 0; i + j < Polynomial::kTerms; ++j) result.c[i + j] += a.c[i] * b.c[j];
  return result;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (std::size_t i = 0; i < Polynomial::kTerms; ++i) result.c[i] = a.c[i] + b.c[i];
  return result;
}

Polynomial operator*(double factor, const Polynomial& a) {
  Polynomial result;
  for (std::size_t i = 0; i < Polynomial::kTerms; ++i) result.c[i] = factor * a.c[i];
  return result;
}

double positiveUpTo(const Polynomial& polynomial, double limit) {
  if (!(polynomial(0.0) > 0.0)) return 0.0;
  std::array<Polynomial, Polynomial::kTerms> derivatives;
  derivatives[0] = polynomial;
  for (std::size_t i = 1; i < derivatives.size(); ++i)
    derivatives[i] = derivatives[i - 1].derivative();
  Roots roots;  // of the last derivative, a constant: none
  for (std::size_t i = derivatives.size() - 1; i > 0; --i)
    roots = rootsBetween(derivatives[i - 1], roots, limit);
  return roots.count > 0 ? roots.at[0] : limit;
}

}  // namespace boresight
