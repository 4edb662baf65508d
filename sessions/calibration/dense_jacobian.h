// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <ceres/ceres.h>
#include <Eigen/Core>

namespace boresight::sessions {

/// Derivatives of a problem's residuals: a row for each residual, a column for each free parameter
/// of `options.parameter_blocks`, in their order. `residuals`: of the rows, or nullptr.
Eigen::MatrixXd denseJacobian(ceres::Problem& problem,
                              const ceres::Problem::EvaluateOptions& options,
                              std::vector<double>* residuals = nullptr);

}  // namespace boresight::sessions
