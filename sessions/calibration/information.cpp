// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/information.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace boresight::sessions {
namespace {

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
    undetermined.push_back(
        {value > 0.0 ? 1.0 / std::sqrt(value) : std::numeric_limits<double>::infinity(),
         namesOf(direction, parameters)});
  }
  covariance = scales.asDiagonal() * covariance * scales.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i)
    parameters[static_cast<std::size_t>(i)].sigma = lost[i] > kNotableShare
                                                        ? std::numeric_limits<double>::infinity()
                                                        : std::sqrt(covariance(i, i));
  return covariance;
}

}  // namespace boresight::sessions
