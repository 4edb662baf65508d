// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/normal_equations.h"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

namespace boresight {
namespace {

constexpr double kMissingSquares = 1e12;  ///< of a residual of 1e6 px at unit sigma
constexpr double kLargestSquares = 1e30;  ///< beyond it a residual says nothing
constexpr double kSmallestSigma = 1e-9;   ///< m or rad
constexpr double kSmallestPivotShare = 1e-12;

/// Lower triangle of H row by row, and g: plain arrays, which compilers keep in registers.
struct Sums {
  std::array<double, 21> h{};
  std::array<double, 6> g{};

  void add(const std::array<double, 6>& row, double weight, double residual) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const double weighted = weight * row[i];
      g[i] += weighted * residual;
      for (std::size_t j = 0; j <= i; ++j) h[k++] += weighted * row[j];
    }
  }
};

std::array<double, 6> imageRow(const Eigen::Vector3d& p, double ax, double ay, double az) {
  return {p.y() * az - p.z() * ay, p.z() * ax - p.x() * az, p.x() * ay - p.y() * ax, ax, ay, az};
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

double priorWeight(double sigma) {
  const double bounded = std::max(sigma, kSmallestSigma);
  return 1.0 / (bounded * bounded);
}

/// L D L' with unit lower triangular L (below the diagonal) and D (on it).
struct Factors {
  double m[6][6];
};

bool factorize(const Matrix6d& information, double damping, Factors& f) {
  for (int j = 0; j < 6; ++j) {
    const double diagonal = information(j, j) * (1.0 + damping);
    double scaled[6];  // row j of L times D
    double pivot = diagonal;
    for (int k = 0; k < j; ++k) {
      scaled[k] = f.m[j][k] * f.m[k][k];
      pivot -= scaled[k] * f.m[j][k];
    }
    // Written so that a NaN fails.
    if (!(diagonal > 0.0 && pivot > kSmallestPivotShare * diagonal && diagonal < 1e300)) {
      return false;
    }
    f.m[j][j] = pivot;
    const double inverse = 1.0 / pivot;
    for (int i = j + 1; i < 6; ++i) {
      double sum = information(i, j);
      for (int k = 0; k < j; ++k) sum -= f.m[i][k] * scaled[k];
      f.m[i][j] = sum * inverse;
    }
  }
  return true;
}

void substitute(const Factors& f, const Vector6d& right, Vector6d& x) {
  x = right;
  for (int i = 1; i < 6; ++i) {
    for (int k = 0; k < i; ++k) x[i] -= f.m[i][k] * x[k];
  }
  for (int i = 0; i < 6; ++i) x[i] /= f.m[i][i];
  for (int i = 4; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k) x[i] -= f.m[k][i] * x[k];
  }
}

}  // namespace

double NormalEquations::cost() const {
  return squares + prior_squares + kMissingSquares * static_cast<double>(missing);
}

NormalEquations reprojectionEquations(std::span<const Correspondence> correspondences,
                                      std::span<const std::uint8_t> use, const Camera& camera,
                                      const Pose& camera_from_station) {
  const Eigen::Matrix3d rotation = camera_from_station.matrix();
  NormalEquations equations;
  Sums sums;
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    if (!use.empty() && use[i] == 0) continue;
    const Correspondence& item = correspondences[i];
    if (!isUsable(item)) continue;
    const Eigen::Vector3d point =
        rotation * item.point_in_station_m + camera_from_station.translation_m;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> a;
    if (!projectWithJacobian(camera, point, pixel, a)) {
      ++equations.missing;
      continue;
    }
    const Eigen::Vector2d residual = item.pixel - pixel;
    const double weight = 1.0 / (item.sigma_px * item.sigma_px);
    const double squares = weight * residual.squaredNorm();
    if (!(squares < kLargestSquares)) {  // nor when it is not a number
      ++equations.missing;
      continue;
    }
    sums.add(imageRow(point, a(0, 0), a(0, 1), a(0, 2)), weight, residual.x());
    sums.add(imageRow(point, a(1, 0), a(1, 1), a(1, 2)), weight, residual.y());
    equations.squares += squares;
    ++equations.projected;
  }
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    equations.gradient[i] = sums.g[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) equations.information(i, j) = sums.h[k++];
  }
  return equations;
}

void addPrior(const PosePrior& prior, const Pose& camera_from_station, NormalEquations& equations) {
  const Eigen::Vector3d& pivot = prior.sigma.pivot_in_camera_m;
  const Vector6d offset = offsetAboutPivot(prior.camera_from_station, camera_from_station, pivot);
  const Eigen::Matrix3d turn = crossMatrix(offset.head<3>());
  Matrix6d rows = Matrix6d::Zero();
  rows.topLeftCorner<3, 3>() =
      Eigen::Matrix3d::Identity() - 0.5 * turn + (1.0 / 12.0) * turn * turn;
  rows.bottomLeftCorner<3, 3>() = -crossMatrix(pivot + offset.tail<3>());
  rows.bottomRightCorner<3, 3>().setIdentity();
  for (int axis = 0; axis < 6; ++axis) {
    const double weight = priorWeight(axis < 3 ? prior.sigma.rotation_rad[axis]
                                               : prior.sigma.translation_m[axis - 3]);
    for (int i = 0; i < 6; ++i) {
      const double weighted = weight * rows(axis, i);
      equations.gradient[i] -= weighted * offset[axis];
      for (int j = 0; j <= i; ++j) equations.information(i, j) += weighted * rows(axis, j);
    }
    equations.prior_squares += weight * offset[axis] * offset[axis];
  }
}

bool solve(const NormalEquations& equations, double damping, Vector6d& xi) {
  Factors factors;
  if (!factorize(equations.information, damping, factors)) return false;
  substitute(factors, equations.gradient, xi);
  return xi.squaredNorm() < 1e12;
}

bool invert(const Matrix6d& information, Matrix6d& covariance) {
  Factors factors;
  if (!factorize(information, 0.0, factors)) return false;
  for (int j = 0; j < 6; ++j) {
    Vector6d column;
    substitute(factors, Vector6d::Unit(j), column);
    for (int i = j; i < 6; ++i) {
      covariance(i, j) = column[i];
      covariance(j, i) = column[i];
    }
  }
  return covariance.squaredNorm() < 1e300;
}

}  // namespace boresight
