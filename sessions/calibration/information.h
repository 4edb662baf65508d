// SPDX-License-Identifier: Apache-2.0
// Information of a least-squares problem on some of its parameters.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace boresight::sessions {

/// A parameter of a calibration.
struct CalibrationParameter {
  std::string name;
  std::string unit;
  double value = 0.0;
  double sigma = 0.0;  ///< one sigma; not finite: not determined
  /// A change of this size is large for the parameter: directions whose sigma exceeds it count as
  /// not determined.
  double scale = 1.0;
};

/// A combination of parameters that the observations do not determine.
struct Undetermined {
  double sigma = 0.0;  ///< in units of the parameters' scales
  std::string text;    ///< "focal_relative with centre_x_px: ..."
};

/// Noise of an adjustment with a Cauchy loss by its residuals in sigmas, by which the covariance
/// (J' J)^-1 is multiplied (squared): root of the mean square of the loss's influence, divided by
/// the mean of the influence's derivative (Huber 1981, 7.6). 1 when the residuals are as their
/// sigmas state; a few that are far out count little.
class NoiseMeter {
 public:
  explicit NoiseMeter(double loss_sigmas) : loss_sigmas_(loss_sigmas) {}
  /// A residual block of this number of dimensions, and its sum of squares.
  void add(double square, int dimensions);
  /// `freedom`: dimensions of all blocks less unknowns; 1 where there is none. Root of the mean
  /// square of the residuals where most of them are far out.
  double noiseFactor(double freedom) const;

 private:
  double loss_sigmas_ = 0.0;
  double squares_ = 0.0;    ///< of the residuals
  double influence_ = 0.0;  ///< sum of squares
  double slope_ = 0.0;      ///< sum over dimensions
  int dimensions_ = 0;
};

/// The information on the first `count` parameters of J'J when the others are free (Schur
/// complement). `jacobian`: rows of residuals over their sigmas.
Eigen::MatrixXd reducedInformation(const Eigen::MatrixXd& jacobian, Eigen::Index count);

/// Covariance and sigmas of the parameters, and undetermined directions: eigenvectors of the
/// information in units of the scales whose sigma exceeds 1, once for each combination of names.
/// Those directions are left out of the covariance, and parameters with a share of more than a
/// tenth in one have no finite sigma.
Eigen::MatrixXd judgeInformation(const Eigen::MatrixXd& information,
                                 std::vector<CalibrationParameter>& parameters,
                                 std::vector<Undetermined>& undetermined);

}  // namespace boresight::sessions
