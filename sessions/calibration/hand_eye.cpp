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

/// base_from_station by each station's first posture.
std::vector<Pose> stationStarts(std::span<const ArmPosture> postures,
                                const Pose& camera_from_end_effector) {
  std::vector<Pose> starts;
  std::vector<bool> known;
  for (const ArmPosture& posture : postures) {
    if (posture.station >= starts.size()) {
      starts.resize(posture.station + 1);
      known.resize(posture.station + 1);
    }
    if (known[posture.station]) continue;
    known[posture.station] = true;
    starts[posture.station] = posture.base_from_end_effector * camera_from_end_effector.inverse() *
                              posture.camera_from_station;
  }
  if (std::ranges::find(known, false) != known.end())
    throw std::invalid_argument("a station has no posture");
  return starts;
}

}  // namespace

HandEye calibrateHandEye(std::span<const ArmPosture> postures,
                         const Pose& camera_from_end_effector_start) {
  std::vector<Pose> station_start = stationStarts(postures, camera_from_end_effector_start);
  if (postures.size() < 3 || postures.size() <= station_start.size())
    throw std::invalid_argument("three postures of the arm are needed, two of them at one station");
  std::array<double, 6> hand{};
  std::vector<std::array<double, 6>> base(station_start.size());
  ceres::Problem problem;
  using Cost = ceres::NumericDiffCostFunction<ArmResidual, ceres::CENTRAL, 6, 6, 6>;
  for (const ArmPosture& posture : postures)
    problem.AddResidualBlock(new Cost(new ArmResidual{&posture, &camera_from_end_effector_start,
                                                      &station_start[posture.station]}),
                             new ceres::CauchyLoss(kArmLossSigmas), hand.data(),
                             base[posture.station].data());
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
  for (std::size_t i = 0; i < base.size(); ++i)
    result.base_from_station.push_back(
        perturbed(Eigen::Map<const Vector6d>(base[i].data()), station_start[i]));
  result.parameters = parametersOf(hand);
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = {hand.data()};
  for (std::array<double, 6>& change : base) evaluate.parameter_blocks.push_back(change.data());
  evaluate.apply_loss_function = false;
  std::vector<double> residuals;
  const Eigen::MatrixXd jacobian = denseJacobian(problem, evaluate, &residuals);
  NoiseMeter meter(kArmLossSigmas);
  for (std::size_t i = 0; i < residuals.size(); i += 6)
    meter.add(Eigen::Map<const Vector6d>(&residuals[i]).squaredNorm(), 6);
  result.noise_factor = meter.noiseFactor(
      6.0 * (static_cast<double>(postures.size()) - 1.0 - static_cast<double>(base.size())));
  const double noise = std::max(1.0, result.noise_factor);
  result.covariance = judgeInformation(reducedInformation(jacobian, 6) / (noise * noise),
                                       result.parameters, result.undetermined);
  return result;
}

}  // namespace boresight::sessions
