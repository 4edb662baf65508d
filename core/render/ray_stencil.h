// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/base/nth.h"

/// Interpolation between the nodes of a RayGrid: polynomials through an even number of equidistant
/// nodes, of which the two in the middle hold the cell that is interpolated.
namespace boresight::stencil {

/// Pixels between nodes.
inline constexpr int kSpacing = 16;

/// Along the 16 pixels of a cell, the polynomial through the nodes of its stencil is summed up from
/// its differences between pixels. Newton's form at node coordinate t (from the stencil's first
/// node) is p(t) = sum_k d_k N_k(t), N_k(t) = t (t - 1) ... (t - k + 1) / k!, d_k the differences
/// between nodes; `at[j][k]` is the j-th difference between pixels of N_k at the cell's first one.
template <int kNodes>
struct StepMatrix {
  double at[kNodes][kNodes] = {};  ///< see above
  constexpr StepMatrix() {
    for (int k = 0; k < kNodes; ++k) {
      double value[kNodes] = {};
      for (int i = 0; i <= k; ++i) {
        value[i] = 1.0;
        for (int j = 0; j < k; ++j)
          value[i] *= (kNodes / 2 - 1 + i / static_cast<double>(kSpacing) - j) / (j + 1);
      }
      for (int j = 0; j <= k; ++j) {
        at[j][k] = value[0];
        for (int i = 0; i + 1 < kNodes; ++i) value[i] = value[i + 1] - value[i];
      }
    }
  }
};
template <int kNodes>
constexpr StepMatrix<kNodes> kSteps{};  ///< the matrix, computed at compile time

/// Lagrange's weights of the stencil's nodes at pixel `i` of a cell.
template <int kNodes>
std::array<double, kNodes> lagrangeWeights(int i) {
  const double s = kNodes / 2 - 1 + i / static_cast<double>(kSpacing);
  std::array<double, kNodes> weights{};
  for (int k = 0; k < kNodes; ++k) {
    double weight = 1.0;
    for (int j = 0; j < kNodes; ++j)
      if (j != k) weight *= (s - j) / (k - j);
    nth(weights, k) = weight;
  }
  return weights;
}

/// Converts values at the stencil's nodes to the value and pixel differences at the cell's first
/// pixel.
template <int kNodes>
std::array<double, kNodes> pixelSteps(std::array<double, kNodes> v) {
  for (std::size_t order = 1; order < kNodes; ++order)
    for (std::size_t k = kNodes - 1; k >= order; --k) v[k] -= v[k - 1];
  std::array<double, kNodes> steps{};
  for (std::size_t j = 0; j < kNodes; ++j)
    for (std::size_t k = j; k < kNodes; ++k) steps[j] += kSteps<kNodes>.at[j][k] * v[k];
  return steps;
}

/// Sums up `count` values from the differences, after `skip` that are not needed: the same bits for
/// every part of a cell.
template <int kNodes>
void sumUp(std::array<double, kNodes> steps, int skip, int count, double* values) {
  for (int i = -skip; i < count; ++i) {
    if (i >= 0) values[i] = steps[0];
    for (std::size_t j = 0; j + 1 < kNodes; ++j) steps[j] += steps[j + 1];
  }
}

/// The values of a cell's pixels from the nodes of its row.
template <int kNodes>
void interpolateCell(const std::array<double, kNodes>& v, int skip, int count, double* values) {
  sumUp<kNodes>(pixelSteps<kNodes>(v), skip, count, values);
}

/// Four nodes, the case of most cameras, written out: p(u) = v1 + u (c1 + u (c2 + u c3)), u in
/// cells.
template <>
inline void interpolateCell<4>(const std::array<double, 4>& v, int skip, int count,
                               double* values) {
  constexpr double kStep = 1.0 / kSpacing;
  const double c3 = (v[3] - v[0]) * (1.0 / 6.0) + (v[1] - v[2]) * 0.5;
  const double c2 = (v[0] + v[2]) * 0.5 - v[1];
  const double c1 = ((v[2] - v[1]) - c2) - c3;
  const double cubic = c3 * (kStep * kStep * kStep);
  const double square = c2 * (kStep * kStep);
  double value = v[1];
  double step1 = (c1 * kStep + square) + cubic;
  double step2 = 2.0 * square + 6.0 * cubic;
  const double step3 = 6.0 * cubic;
  const auto stepOn = [&] {
    value += step1;
    step1 += step2;
    step2 += step3;
  };
  if (count == kSpacing) {
    for (int i = 0; i < kSpacing; ++i, stepOn()) values[i] = value;
    return;
  }
  for (int i = 0; i < skip; ++i) stepOn();
  for (int i = 0; i < count; ++i, stepOn()) values[i] = value;
}

}  // namespace boresight::stencil
