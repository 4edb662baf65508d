// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/hand_eye.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <ceres/ceres.h>

#include "sessions/calibration/dense_jacobian.h"

namespace boresight::sessions {
namespace {

constexpr double kArmLossSigmas = 3.0;
constexpr double kRotationScale_rad = 0.1;
constexpr double kTranslationScale_m = 0.1;

/// Difference between the end effector by telemetry and that by image and mounting, in sigmas.
struct ArmResidual {
  const ArmPosture* posture;
  const Pose* camera_from_end_effector;
  const Pose* base_from_station;

  bool operator()(const double* hand, const double* base, double* residual) const {
    const Pose mounting = perturbed(Eigen::Map<const Vector6d>(hand), *camera_from_end_effector);
    const Pose station = perturbed(Eigen::Map<const Vector6d>(base), *base_from_station);
    const Pose by_image = station * posture->camera_from_station.inverse() * mounting;
    const Pose off = by_image.inverse() * posture->base_from_end_effector;
    const Eigen::Vector3d turn = rotationLog(off.rotation) / posture->sigma_rotation_rad;
    const Eigen::Vector3d shift = off.translation_m / posture->sigma_translation_m;
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = turn[axis];
      residual[3 + axis] = shift[axis];
    }
    return true;
  }
};

std::vector<CalibrationParameter> parametersOf(const std::array<double, 6>& change) {
  static const char* const kNames[] = {"rotation_x_rad",  "rotation_y_rad",  "rotation_z_rad",
                                       "translation_x_m", "translation_y_m", "translation_z_m"};
  std::vector<CalibrationParameter> parameters;
  for (std::size_t i = 0; i < 6; ++i)
    parameters.push_back({kNames[i], i < 3 ? "rad" : "m", change[i], 0.0,
                          i < 3 ? kRotationScale_rad : kTranslationScale_m});
  return parameters;
}

}  // namespace

HandEye calibrateHandEye(std::span<const ArmPosture> postures,
                         const Pose& camera_from_end_effector_start) {
  if (postures.size() < 3) throw std::invalid_argument("three postures of the arm are needed");
  const Pose station_start = postures.front().base_from_end_effector *
                             camera_from_end_effector_start.inverse() *
                             postures.front().camera_from_station;
  std::array<double, 6> hand{};
  std::array<double, 6> base{};
  ceres::Problem problem;
  using Cost = ceres::NumericDiffCostFunction<ArmResidual, ceres::CENTRAL, 6, 6, 6>;
  for (const ArmPosture& posture : postures)
    problem.AddResidualBlock(
        new Cost(new ArmResidual{&posture, &camera_from_end_effector_start, &station_start}),
        new ceres::CauchyLoss(kArmLossSigmas), hand.data(), base.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("the adjustment does not converge");

  HandEye result;
  result.camera_from_end_effector =
      perturbed(Eigen::Map<const Vector6d>(hand.data()), camera_from_end_effector_start);
  result.base_from_station = perturbed(Eigen::Map<const Vector6d>(base.data()), station_start);
  result.parameters = parametersOf(hand);
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = {hand.data(), base.data()};
  evaluate.apply_loss_function = false;
  double half_squares = 0.0;
  const Eigen::MatrixXd jacobian = denseJacobian(problem, evaluate, &half_squares);
  const double freedom = 6.0 * static_cast<double>(postures.size()) - 12.0;
  if (freedom > 0.0) result.noise_factor = std::sqrt(2.0 * half_squares / freedom);
  const double noise = std::max(1.0, result.noise_factor);
  result.covariance = judgeInformation(reducedInformation(jacobian, 6) / (noise * noise),
                                       result.parameters, result.undetermined);
  return result;
}

}  // namespace boresight::sessions
