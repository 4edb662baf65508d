// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/normal_equations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr double kMissingSquares = 1e12;  ///< of a residual of 1e6 px at unit sigma
constexpr double kLargestSquares = 1e30;  ///< beyond it a residual carries no information
constexpr double kSmallestSigma = 1e-9;   ///< m or rad
constexpr double kSmallestPivot = 1e-12;  ///< of H scaled to a unit diagonal

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

/// P S H S P' = L D L' with S = diag(H)^-1/2 and the largest remaining pivot taken first: the last
/// pivot then measures how well the least determined direction is determined.
struct Factors {
  std::array<double, 6> scale{};       ///< S
  std::array<std::size_t, 6> order{};  ///< P: row k of L is parameter order[k]
  double m[6][6] = {};                 ///< unit lower triangular L below the diagonal, D on it
};

void swapParameters(Factors& f, std::size_t a, std::size_t b) {
  if (a == b) return;
  std::swap(f.order[a], f.order[b]);
  for (std::size_t i = 0; i < 6; ++i) std::swap(f.m[a][i], f.m[b][i]);
  for (std::size_t i = 0; i < 6; ++i) std::swap(f.m[i][a], f.m[i][b]);
}

bool scaleToUnitDiagonal(const Matrix6d& information, double damping, Factors& f) {
  for (int i = 0; i < 6; ++i) {
    const double diagonal = information(i, i);
    if (!(diagonal > 0.0 && diagonal < 1e300)) return false;  // nor when it is not a number
    nth(f.scale, i) = 1.0 / std::sqrt(diagonal);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    f.order[i] = i;
    for (std::size_t j = 0; j < i; ++j) {
      f.m[i][j] = information(static_cast<int>(i), static_cast<int>(j)) * f.scale[i] * f.scale[j];
      f.m[j][i] = f.m[i][j];
    }
    f.m[i][i] = 1.0 + damping;
  }
  return true;
}

bool factorize(const Matrix6d& information, double damping, Factors& f) {
  if (!scaleToUnitDiagonal(information, damping, f)) return false;
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t largest = k;
    for (std::size_t i = k + 1; i < 6; ++i) {
      if (f.m[i][i] > f.m[largest][largest]) largest = i;
    }
    swapParameters(f, k, largest);
    const double pivot = f.m[k][k];
    if (!(pivot > kSmallestPivot)) return false;  // nor when it is not a number
    const double inverse = 1.0 / pivot;
    for (std::size_t i = k + 1; i < 6; ++i) f.m[i][k] = f.m[k][i] * inverse;
    for (std::size_t i = k + 1; i < 6; ++i) {
      for (std::size_t j = k + 1; j <= i; ++j) {
        f.m[i][j] -= f.m[i][k] * f.m[k][j];
        f.m[j][i] = f.m[i][j];
      }
    }
  }
  return true;
}

void substitute(const Factors& f, const Vector6d& right, Vector6d& x) {
  std::array<double, 6> y{};
  for (std::size_t i = 0; i < 6; ++i) {
    y[i] = right[static_cast<int>(f.order[i])] * f.scale[f.order[i]];
    for (std::size_t k = 0; k < i; ++k) y[i] -= f.m[i][k] * y[k];
  }
  for (std::size_t i = 0; i < 6; ++i) y[i] /= f.m[i][i];
  for (std::size_t i = 5; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) y[i] -= f.m[k][i] * y[k];
  }
  for (std::size_t i = 0; i < 6; ++i) x[static_cast<int>(f.order[i])] = y[i] * f.scale[f.order[i]];
}

}  // namespace

double NormalEquations::cost() const {
  return squares + prior_squares + kMissingSquares * static_cast<double>(missing);
}

NormalEquations reprojectionEquations(std::span<const Correspondence> correspondences,
                                      std::span<const std::uint8_t> use, const Camera& camera,
                                      const Pose& camera_from_station) {
  const PoseMatrix to_camera(camera_from_station);
  NormalEquations equations;
  Sums sums;
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    if (!use.empty() && use[i] == 0) continue;
    const Correspondence& item = correspondences[i];
    if (!isUsable(item)) continue;
    const Eigen::Vector3d point = to_camera * item.point_in_station_m;
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
    equations.gradient[i] = nth(sums.g, i);
    for (int j = 0; j <= i; ++j) equations.information(i, j) = sums.h[k++];
  }
  return equations;
}

NormalEquations reprojectionEquations(std::span<const Correspondence> correspondences,
                                      std::span<const std::uint8_t> use,
                                      std::span<const PnpView> views,
                                      const Pose& first_from_station) {
  NormalEquations sum;
  std::size_t begin = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const auto count = static_cast<std::size_t>(views[v].end) - begin;
    const NormalEquations own = reprojectionEquations(
        correspondences.subspan(begin, count), use.empty() ? use : use.subspan(begin, count),
        *views[v].camera, poseOfView(views, v, first_from_station));
    if (v == 0)
      sum = own;
    else
      addTo(sum, inFirst(own, views[v].camera_from_first));
    begin += count;
  }
  return sum;
}

Matrix6d adjointOf(const Pose& a_from_b) {
  const Eigen::Matrix3d rotation = a_from_b.matrix();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = rotation;
  adjoint.bottomLeftCorner<3, 3>() = crossMatrix(a_from_b.translation_m) * rotation;
  adjoint.bottomRightCorner<3, 3>() = rotation;
  return adjoint;
}

Matrix6d covarianceIn(const Pose& a_from_b, const Matrix6d& covariance_in_b) {
  const Matrix6d adjoint = adjointOf(a_from_b);
  return adjoint * covariance_in_b * adjoint.transpose();
}

NormalEquations inFirst(const NormalEquations& equations, const Pose& camera_from_first) {
  const Matrix6d adjoint = adjointOf(camera_from_first);
  const Matrix6d whole = equations.information.selfadjointView<Eigen::Lower>();
  NormalEquations brought = equations;
  brought.information = adjoint.transpose() * whole * adjoint;
  brought.gradient = adjoint.transpose() * equations.gradient;
  return brought;
}

void addRow(const Vector6d& row, double weight, double residual, NormalEquations& sum) {
  for (int a = 0; a < 6; ++a) {
    const double weighted = weight * row[a];
    sum.gradient[a] += weighted * residual;
    for (int b = 0; b <= a; ++b) sum.information(a, b) += weighted * row[b];
  }
  sum.squares += weight * residual * residual;
  ++sum.projected;
}

Vector6d lineRow(const Eigen::Vector3d& point_in_camera_m, const Eigen::Vector2d& normal,
                 const Eigen::Matrix<double, 2, 3>& jacobian) {
  const Eigen::Vector3d slope = (normal.transpose() * jacobian).transpose();
  Vector6d row;
  row << point_in_camera_m.cross(slope), slope;
  return row;
}

void addTo(NormalEquations& sum, const NormalEquations& equations) {
  sum.information += equations.information;
  sum.gradient += equations.gradient;
  sum.squares += equations.squares;
  sum.prior_squares += equations.prior_squares;
  sum.projected += equations.projected;
  sum.missing += equations.missing;
}

void addPrior(const PosePrior& prior, const Pose& camera_from_station, NormalEquations& equations) {
  const Eigen::Vector3d& pivot = prior.sigma.pivot_in_camera_m;
  const Vector6d offset = offsetAboutPivot(prior.camera_from_station, camera_from_station, pivot);
  const Eigen::Matrix3d turn = crossMatrix(offset.head<3>());
  const Eigen::Matrix3d turn_by_omega =
      Eigen::Matrix3d::Identity() - 0.5 * turn + (1.0 / 12.0) * turn * turn;
  const Eigen::Matrix3d shift_by_omega = -crossMatrix(pivot + offset.tail<3>());
  Matrix6d& h = equations.information;
  Vector6d& g = equations.gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const double turn_weight = priorWeight(prior.sigma.rotation_rad[axis]);
    const double shift_weight = priorWeight(prior.sigma.translation_m[axis]);
    const double turn_pull = turn_weight * offset[axis];
    const double shift_pull = shift_weight * offset[3 + axis];
    for (int i = 0; i < 3; ++i) {
      const double by_turn = turn_weight * turn_by_omega(axis, i);
      const double by_shift = shift_weight * shift_by_omega(axis, i);
      g[i] -= turn_pull * turn_by_omega(axis, i) + shift_pull * shift_by_omega(axis, i);
      for (int j = 0; j <= i; ++j) {
        h(i, j) += by_turn * turn_by_omega(axis, j) + by_shift * shift_by_omega(axis, j);
      }
      h(3 + axis, i) += by_shift;
    }
    g[3 + axis] -= shift_pull;
    h(3 + axis, 3 + axis) += shift_weight;
    equations.prior_squares += turn_pull * offset[axis] + shift_pull * offset[3 + axis];
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
