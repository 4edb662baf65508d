// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/dense_jacobian.h"

namespace boresight::sessions {

Eigen::MatrixXd denseJacobian(ceres::Problem& problem,
                              const ceres::Problem::EvaluateOptions& options,
                              std::vector<double>* residuals) {
  ceres::CRSMatrix sparse;
  problem.Evaluate(options, nullptr, residuals, nullptr, &sparse);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
    for (int k = sparse.rows[static_cast<std::size_t>(row)];
         k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k)
      dense(row, sparse.cols[static_cast<std::size_t>(k)]) =
          sparse.values[static_cast<std::size_t>(k)];
  return dense;
}

}  // namespace boresight::sessions
