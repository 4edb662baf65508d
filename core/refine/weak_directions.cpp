// SPDX-License-Identifier: Apache-2.0
#include "core/refine/weak_directions.h"

#include <algorithm>
#include <cmath>

#include "core/base/symmetric_eigen.h"
#include "core/pnp/normal_equations.h"

namespace boresight {
namespace {

constexpr std::int32_t kMostPlaces = 1500;  ///< enough for the means
constexpr std::int32_t kLeastPlaces = 12;

/// Adds the outer product of a row to the lower triangle.
void addSquare(const Vector6d& row, Matrix6d& sum) {
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b <= a; ++b) sum(a, b) += row[a] * row[b];
}

/// L with L L' = the matrix, given by its lower triangle. False when it is not positive definite.
bool factorize(const Matrix6d& lower, Matrix6d& factor) {
  constexpr double kLeastPivot = 1e-12;  // relative to the diagonal
  factor.setZero();
  for (int column = 0; column < 6; ++column) {
    for (int row = column; row < 6; ++row) {
      double sum = lower(row, column);
      for (int k = 0; k < column; ++k) sum -= factor(row, k) * factor(column, k);
      if (row == column) {
        if (!(sum > kLeastPivot * lower(column, column))) return false;
        factor(column, column) = std::sqrt(sum);
      } else {
        factor(row, column) = sum / factor(column, column);
      }
    }
  }
  return true;
}

/// x with L x = b, column by column.
Matrix6d solveLower(const Matrix6d& factor, Matrix6d b) {
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      for (int k = 0; k < row; ++k) b(row, column) -= factor(row, k) * b(k, column);
      b(row, column) /= factor(row, row);
    }
  }
  return b;
}

/// x with L' x = b.
Vector6d solveUpper(const Matrix6d& factor, Vector6d b) {
  for (int row = 5; row >= 0; --row) {
    for (int k = row + 1; k < 6; ++k) b[row] -= factor(k, row) * b[k];
    b[row] /= factor(row, row);
  }
  return b;
}

}  // namespace

WeakDirections weakDirections(const RefinementResult& refined, const Camera& camera,
                              const Eigen::Vector3d& centre_in_station_m) {
  WeakDirections weak;
  const Pose& pose = refined.camera_from_station;
  weak.pivot_in_camera_m = pose * centre_in_station_m;
  const Eigen::Matrix3d rotation = pose.matrix();
  const std::int32_t stride = std::max(1, (refined.sample_count + kMostPlaces - 1) / kMostPlaces);
  Matrix6d normal = Matrix6d::Zero();
  Matrix6d motion = Matrix6d::Zero();
  std::int32_t places = 0;
  for (std::int32_t i = 0; i < refined.sample_count; i += stride) {
    const EdgeSample& sample = refined.samples[static_cast<std::size_t>(i)];
    const Eigen::Vector3d point_m = rotation * sample.point_in_station_m + pose.translation_m;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!projectWithJacobian(camera, point_m, pixel, jacobian)) continue;
    const Eigen::Vector3d arm_m = point_m - weak.pivot_in_camera_m;
    addSquare(lineRow(arm_m, sample.normal(), jacobian), normal);
    addSquare(lineRow(arm_m, Eigen::Vector2d::UnitX(), jacobian), motion);
    addSquare(lineRow(arm_m, Eigen::Vector2d::UnitY(), jacobian), motion);
    ++places;
  }
  Matrix6d factor;
  if (places < kLeastPlaces || !factorize(motion / places, factor)) return weak;
  const Matrix6d mean = normal / places;
  const Matrix6d full = mean.selfadjointView<Eigen::Lower>();
  const Matrix6d half = solveLower(factor, full);
  const SymmetricEigen<6> eigen(solveLower(factor, half.transpose()));
  for (std::size_t i = 0; i < weak.offset_per_px.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    weak.offset_per_px[i] = solveUpper(factor, eigen.vectors.col(at));
    weak.seen[i] = std::sqrt(std::max(0.0, eigen.values[at]));
  }
  weak.known = true;
  return weak;
}

}  // namespace boresight
