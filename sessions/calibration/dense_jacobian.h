// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>
#include <Eigen/Core>

namespace boresight::sessions {

/// Derivatives of a problem's residuals: a row for each residual, a column for each free parameter
/// of `options.parameter_blocks`, in their order. `cost`: half the sum of squares, or nullptr.
Eigen::MatrixXd denseJacobian(ceres::Problem& problem,
                              const ceres::Problem::EvaluateOptions& options,
                              double* cost = nullptr);

}  // namespace boresight::sessions
