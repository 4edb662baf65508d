// SPDX-License-Identifier: Apache-2.0
#include "core/refine/weak_directions.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/base/symmetric_eigen.h"
#include "core/pnp/normal_equations.h"

namespace boresight {
namespace {

constexpr std::int32_t kMostMeanPlaces = 1500;  ///< enough for the means
constexpr std::int32_t kLeastMeanPlaces = 12;

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

/// A small offset about the pivot as one about the camera's centre.
Vector6d aboutCamera(const Vector6d& offset, const Eigen::Vector3d& pivot_in_camera_m) {
  Vector6d moved = offset;
  moved.tail<3>() -= offset.head<3>().cross(pivot_in_camera_m);
  return moved;
}

/// Variance of the motion along a direction (about the camera's centre) that the seed's
/// uncertainty, taken as a Gaussian, leaves.
double varianceAlong(const Vector6d& direction, const SeedUncertainty& uncertainty) {
  const Vector6d offset = aboutCamera(direction, -uncertainty.pivot_in_camera_m);
  double information = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double sigma =
        kUniformSigma * (i < 3 ? uncertainty.rotation_rad[i] : uncertainty.translation_m[i - 3]);
    constexpr double kLeast = 1e-9;  // rad or m: known exactly
    const double ratio = offset[i] / std::max(sigma, kLeast);
    information += ratio * ratio;
  }
  return information > 0.0 ? 1.0 / information : 0.0;
}

}  // namespace

void EdgeMotion::add(const RefinementResult& refined, const Camera& camera,
                     const Pose& camera_from_first) {
  const PoseMatrix camera_from_station(refined.camera_from_station);
  const Eigen::Matrix3d from_first = camera_from_first.matrix();
  const Eigen::Vector3d pivot_m = camera_from_first * pivot_in_camera_m_;
  const std::int32_t stride =
      std::max(1, (refined.sample_count + kMostMeanPlaces - 1) / kMostMeanPlaces);
  for (std::int32_t i = 0; i < refined.sample_count; i += stride) {
    const EdgeSample& sample = nth(refined.samples, i);
    const Eigen::Vector3d point_m = camera_from_station * sample.point_in_station_m;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!projectWithJacobian(camera, point_m, pixel, jacobian)) continue;
    const Eigen::Vector3d arm_m = from_first.transpose() * (point_m - pivot_m);
    jacobian = (jacobian * from_first).eval();
    addSquare(lineRow(arm_m, sample.normal(), jacobian), along_normals_);
    addSquare(lineRow(arm_m, Eigen::Vector2d::UnitX(), jacobian), in_image_);
    addSquare(lineRow(arm_m, Eigen::Vector2d::UnitY(), jacobian), in_image_);
    ++places_;
  }
}

WeakDirections EdgeMotion::weakDirections() const {
  WeakDirections weak;
  weak.pivot_in_camera_m = pivot_in_camera_m_;
  Matrix6d factor;
  if (places_ < kLeastMeanPlaces || !factorize(in_image_ / places_, factor)) return weak;
  const Matrix6d mean = along_normals_ / places_;
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

WeakDirections weakDirections(const RefinementResult& refined, const Camera& camera,
                              const Eigen::Vector3d& centre_in_station_m) {
  EdgeMotion motion(refined.camera_from_station * centre_in_station_m);
  motion.add(refined, camera);
  return motion.weakDirections();
}

Matrix6d withUndetermined(const Matrix6d& covariance, const WeakDirections& weak,
                          const SeedUncertainty& uncertainty) {
  Matrix6d sum = covariance;
  for (std::size_t i = 0; i < weak.offset_per_px.size(); ++i) {
    if (!weak.isUndetermined(i)) continue;
    const Vector6d direction = aboutCamera(weak.offset_per_px[i], weak.pivot_in_camera_m);
    const double variance_px2 = varianceAlong(direction, uncertainty);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) sum(a, b) += variance_px2 * direction[a] * direction[b];
  }
  return sum;
}

}  // namespace boresight
