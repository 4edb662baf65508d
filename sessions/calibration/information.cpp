// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/information.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace boresight::sessions {
namespace {

/// Mean derivative of the influence below which it says nothing: that of noise 7 times as large.
constexpr double kLeastSlope = 0.1;
constexpr double kNotableShare = 0.1;  ///< of a unit eigenvector, squared

std::string namesOf(const Eigen::VectorXd& direction,
                    const std::vector<CalibrationParameter>& parameters) {
  std::string text;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double part = direction[static_cast<Eigen::Index>(i)];
    if (part * part > kNotableShare) text += (text.empty() ? "" : " with ") + parameters[i].name;
  }
  return text;
}

}  // namespace

void NoiseMeter::add(double square, int dimensions) {
  const double weight = 1.0 / (1.0 + square / (loss_sigmas_ * loss_sigmas_));
  const double by_square = -weight * weight / (loss_sigmas_ * loss_sigmas_);
  squares_ += square;
  influence_ += weight * weight * square;
  slope_ += dimensions * weight + 2.0 * by_square * square;
  dimensions_ += dimensions;
}

double NoiseMeter::noiseFactor(double freedom) const {
  if (!(freedom > 0.0)) return 1.0;
  if (!(slope_ > kLeastSlope * dimensions_)) return std::sqrt(squares_ / freedom);
  return std::sqrt(influence_ / freedom) * dimensions_ / slope_;
}

Eigen::MatrixXd reducedInformation(const Eigen::MatrixXd& jacobian, Eigen::Index count) {
  const Eigen::Index others = jacobian.cols() - count;
  const Eigen::MatrixXd all = jacobian.transpose() * jacobian;
  if (others == 0) return all;
  const Eigen::MatrixXd cross = all.topRightCorner(count, others);
  const Eigen::MatrixXd own = all.bottomRightCorner(others, others);
  return all.topLeftCorner(count, count) - cross * own.ldlt().solve(cross.transpose());
}

Eigen::MatrixXd judgeInformation(const Eigen::MatrixXd& information,
                                 std::vector<CalibrationParameter>& parameters,
                                 std::vector<Undetermined>& undetermined) {
  const auto count = static_cast<Eigen::Index>(parameters.size());
  Eigen::VectorXd scales(count);
  for (Eigen::Index i = 0; i < count; ++i)
    scales[i] = parameters[static_cast<std::size_t>(i)].scale;
  const Eigen::MatrixXd scaled = scales.asDiagonal() * information * scales.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd direction = eigen.eigenvectors().col(k);
    const double value = eigen.eigenvalues()[k];
    if (value > 1.0) {
      covariance += direction * direction.transpose() / value;
      continue;
    }
    lost += direction.cwiseAbs2();
    // Ascending: the first of equal names has the largest sigma.
    const std::string names = namesOf(direction, parameters);
    if (std::ranges::find(undetermined, names, &Undetermined::text) != undetermined.end()) continue;
    undetermined.push_back(
        {value > 0.0 ? 1.0 / std::sqrt(value) : std::numeric_limits<double>::infinity(), names});
  }
  covariance = scales.asDiagonal() * covariance * scales.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i)
    parameters[static_cast<std::size_t>(i)].sigma = lost[i] > kNotableShare
                                                        ? std::numeric_limits<double>::infinity()
                                                        : std::sqrt(covariance(i, i));
  return covariance;
}

}  // namespace boresight::sessions
