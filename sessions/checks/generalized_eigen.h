// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/symmetric_eigen.h"

namespace boresight::sessions {

/// Solutions of A x = lambda B x of symmetric matrices, B positive definite: lambda ascending, x
/// with x' B x = 1 as columns. Empty when B is not positive definite or a value is not finite. With
/// B = V D V' they are those of the symmetric D^-1/2 V' A V D^-1/2.
template <int kSize>
std::optional<SymmetricEigen<kSize>> generalizedEigen(
    const Eigen::Matrix<double, kSize, kSize>& a, const Eigen::Matrix<double, kSize, kSize>& b) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  if (!a.allFinite() || !b.allFinite()) return std::nullopt;
  const SymmetricEigen<kSize> of_b(b);
  if (!(of_b.values[0] > 0.0)) return std::nullopt;
  const Matrix root = of_b.vectors * of_b.values.cwiseSqrt().cwiseInverse().asDiagonal();
  const Matrix whitened = root.transpose() * a * root;
  SymmetricEigen<kSize> eigen(0.5 * (whitened + whitened.transpose()));
  eigen.vectors = root * eigen.vectors;
  return eigen;
}

}  // namespace boresight::sessions
