// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree_rad = kPi / 180.0;
/// Standard deviation of a uniform distribution, over half of its width: 1 / sqrt(3).
inline constexpr double kUniformSigma = 0.57735026918962576;

/// Neither infinite nor a NaN.
inline bool isFinite(double x) { return x - x == 0.0; }

/// Elementary functions made of + - * / and sqrt in a fixed order, so that every machine gives the
/// same bits; the C library's differ between versions and processors. Absolute error below 4e-16
/// times max(1, |result|) for |x| <= 100 (sin, cos, tan away from its poles), any x (the rest).
/// Sine and cosine lose accuracy beyond |x| = 1e6 but stay in [-1, 1]; a NaN gives a NaN, and so
/// does an infinite angle.
double sine(double x_rad);
double cosine(double x_rad);
double tangent(double x_rad);
double arcTangent(double x);
/// Angle of (x, y) in (-pi, pi]; 0 for (0, 0).
double arcTangent2(double y, double x);
double arcSine(double x);  ///< x clamped to [-1, 1]
/// exp and natural logarithm, for tests' noise and statistics; log(x <= 0) gives -1e308.
double exponential(double x);
double naturalLogarithm(double x);

}  // namespace boresight
