// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight {

/// Eigenvectors of a symmetric matrix as columns, in ascending order of their eigenvalues.
template <int kSize>
struct SymmetricEigen {
  Eigen::Matrix<double, kSize, 1> values;       ///< ascending
  Eigen::Matrix<double, kSize, kSize> vectors;  ///< columns, orthonormal

  /// Cyclic Jacobi rotations (Golub and Van Loan, "Matrix Computations", Sec. 8.5), at most 20
  /// sweeps; the same bits on every machine.
  explicit SymmetricEigen(Eigen::Matrix<double, kSize, kSize> matrix) {
    constexpr int kMostSweeps = 20;
    vectors.setIdentity();
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      bool changed = false;
      for (int p = 0; p < kSize; ++p)
        for (int q = p + 1; q < kSize; ++q) changed = rotate(p, q, matrix) || changed;
      if (!changed) break;
    }
    values = matrix.diagonal();
    sort();
  }

 private:
  /// Makes matrix(p, q) 0; false when it is negligible already.
  bool rotate(int p, int q, Eigen::Matrix<double, kSize, kSize>& matrix) {
    constexpr double kNegligible = 1e-16;
    const double off = matrix(p, q);
    if (!(std::abs(off) > kNegligible * std::sqrt(std::abs(matrix(p, p) * matrix(q, q))))) {
      return false;
    }
    const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * off);
    const double t =
        (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0);
    const double s = t * c;
    for (int k = 0; k < kSize; ++k) {
      const double kp = matrix(k, p);
      const double kq = matrix(k, q);
      matrix(k, p) = c * kp - s * kq;
      matrix(k, q) = s * kp + c * kq;
    }
    for (int k = 0; k < kSize; ++k) {
      const double pk = matrix(p, k);
      const double qk = matrix(q, k);
      matrix(p, k) = c * pk - s * qk;
      matrix(q, k) = s * pk + c * qk;
      const double vp = vectors(k, p);
      const double vq = vectors(k, q);
      vectors(k, p) = c * vp - s * vq;
      vectors(k, q) = s * vp + c * vq;
    }
    return true;
  }

  void sort() {
    for (int i = 0; i < kSize; ++i) {
      int least = i;
      for (int k = i + 1; k < kSize; ++k)
        if (values[k] < values[least]) least = k;
      std::swap(values[i], values[least]);
      vectors.col(i).swap(vectors.col(least));
    }
  }
};

}  // namespace boresight
