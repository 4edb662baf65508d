// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace boresight {

/// c[0] + c[1] x + ... + c[15] x^15: the conditions that bound a distortion model's valid field.
struct Polynomial {
  static constexpr std::size_t kTerms = 16;  ///< coefficients
  std::array<double, kTerms> c{};            ///< c[k] belongs to x^k

  double operator()(double x) const;  ///< Value at x
  Polynomial derivative() const;      ///< Its derivative
};

/// Terms beyond x^15 are dropped; no product here reaches them.
Polynomial operator*(const Polynomial& a, const Polynomial& b);
Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator*(double factor, const Polynomial& a);

/// The largest x <= limit such that the polynomial stays positive on [0, x] (a root that it only
/// touches does not count); 0 when it is not positive at 0. Between two neighbouring roots of the
/// derivative a polynomial is monotone, so bisection there finds every root.
double positiveUpTo(const Polynomial& polynomial, double limit);

}  // namespace boresight
