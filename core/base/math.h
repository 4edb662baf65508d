// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace boresight {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree_rad = kPi / 180.0;
/// Standard deviation of a uniform distribution, over half of its width: 1 / sqrt(3).
inline constexpr double kUniformSigma = 0.57735026918962576;

/// Neither infinite nor a NaN.
inline bool isFinite(double x) { return x - x == 0.0; }

/// The nearest integer, halves up; `x` must fit.
inline int nearestInt(double x) { return static_cast<int>(std::floor(x + 0.5)); }

/// Elementary functions from + - * / and sqrt in a fixed order, so that every machine gives the
/// same bits; those of the C library differ between versions and processors. Absolute error below
/// 4e-16 times max(1, |result|) for |x| <= 100 (sin, cos, tan away from its poles), any x (others).
/// sin and cos lose accuracy beyond |x| = 1e6 but stay in [-1, 1]. A NaN or an infinite angle gives
/// a NaN. Inside the namespace these names hide the C library's.
double sin(double x_rad);
double cos(double x_rad);
double tan(double x_rad);
double atan(double x);
/// Angle of (x, y) in (-pi, pi]; 0 for (0, 0).
double atan2(double y, double x);
double asin(double x);  ///< x clamped to [-1, 1]
double exp(double x);
double log(double x);  ///< natural logarithm; -1e308 for x <= 0

}  // namespace boresight
