// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/camera_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>

#include <ceres/ceres.h>

#include "core/geometry/pose.h"
#include "sessions/calibration/dense_jacobian.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr int kCoefficients = 8;
constexpr int kCameraSize = 3 + kCoefficients;  ///< focal, centre, distortion
constexpr double kLossSigmas = 3.0;
constexpr double kFarOut_sigmas = 10.0;
constexpr int kMostIterations = 100;
/// Changes that are large: 5 % of the focal length, 50 px, 0.5 of a coefficient.
constexpr double kFocalScale = 0.05;
constexpr double kCentreScale_px = 50.0;
constexpr double kDistortionScale = 0.5;

using CameraChange = std::array<double, kCameraSize>;
using PoseChange = std::array<double, 6>;

bool changedCamera(const Camera& camera, const double* change, Camera& result) {
  result = camera;
  result.fx *= std::exp(change[0]);
  result.fy *= std::exp(change[0]);
  result.cx += change[1];
  result.cy += change[2];
  bool distorted = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kCoefficients); ++i) {
    result.distortion[i] += change[3 + i];
    distorted = distorted || change[3 + i] != 0.0;
  }
  return !distorted || prepareCamera(result) == Status::kOk;
}

/// Residual of an observation in units of its sigma; the second one is 0 where only a normal
/// counts.
struct Residual {
  const Camera* camera;
  const Pose* camera_from_station;
  const PointObservation* observation;

  bool operator()(const double* camera_change, const double* pose_change, double* residual) const {
    Camera changed;
    if (!changedCamera(*camera, camera_change, changed)) return false;
    const Pose pose = perturbed(Eigen::Map<const Vector6d>(pose_change), *camera_from_station);
    Eigen::Vector2d pixel;
    if (!project(changed, pose * observation->point_in_station_m, pixel)) return false;
    const Eigen::Vector2d off = (observation->pixel - pixel) / observation->sigma_px;
    const bool along = !observation->normal.isZero(0.0);
    residual[0] = along ? observation->normal.dot(off) : off.x();
    residual[1] = along ? 0.0 : off.y();
    return true;
  }
};

/// Indices into a CameraChange that are adjusted.
std::vector<int> freeIndices(const Camera& camera, const FreeParameters& free) {
  std::vector<int> indices;
  if (free.focal) indices.push_back(0);
  if (free.centre) indices.insert(indices.end(), {1, 2});
  const int coefficients = free.distortion ? coefficientCount(camera) : 0;
  if (free.distortion && coefficients == 0)
    throw std::invalid_argument(
        "this camera model has no distortion that can be adjusted; free focal and centre only");
  for (int i = 0; i < coefficients; ++i) indices.push_back(3 + i);
  return indices;
}

CalibrationParameter parameterOf(int index, const Camera& adjusted, const CameraChange& change) {
  static const char* const kBrown[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  const auto at = static_cast<std::size_t>(index);
  if (index == 0) return {"focal_relative", "", std::exp(change[0]) - 1.0, 0.0, kFocalScale};
  if (index < 3)
    return {index == 1 ? "centre_x_px" : "centre_y_px", "px", change[at], 0.0, kCentreScale_px};
  const std::string name = adjusted.model == CameraModel::kKannalaBrandt
                               ? "k" + std::to_string(index - 2)
                               : kBrown[index - 3];
  return {name, "", adjusted.distortion[at - 3], 0.0, kDistortionScale};
}

/// The adjustment: unknowns and the problem over them.
struct Adjustment {
  CameraChange camera{};
  std::vector<PoseChange> poses;
  ceres::Problem problem;
  int observations = 0;  ///< scalar ones

  Adjustment(const Camera& start, std::span<const CalibrationView> views,
             const std::vector<int>& free)
      : poses(views.size()) {
    problem.AddParameterBlock(camera.data(), kCameraSize);
    std::vector<int> fixed;
    for (int i = 0; i < kCameraSize; ++i)
      if (std::find(free.begin(), free.end(), i) == free.end()) fixed.push_back(i);
    if (!fixed.empty())
      problem.SetManifold(camera.data(), new ceres::SubsetManifold(kCameraSize, fixed));
    for (std::size_t v = 0; v < views.size(); ++v)
      for (const PointObservation& observation : views[v].points) {
        using Cost = ceres::NumericDiffCostFunction<Residual, ceres::CENTRAL, 2, kCameraSize, 6>;
        problem.AddResidualBlock(
            new Cost(new Residual{&start, &views[v].camera_from_station, &observation}),
            new ceres::CauchyLoss(kLossSigmas), camera.data(), poses[v].data());
        observations += observation.normal.isZero(0.0) ? 2 : 1;
      }
  }

  void solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering.reset(new ceres::ParameterBlockOrdering);
    for (PoseChange& pose : poses)
      options.linear_solver_ordering->AddElementToGroup(pose.data(), 0);
    options.linear_solver_ordering->AddElementToGroup(camera.data(), 1);
    options.max_num_iterations = kMostIterations;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
      throw std::runtime_error("the adjustment does not converge; check the observations");
  }

  /// Rows of residuals over their sigmas, free camera parameters first; without the loss, which
  /// the noise factor accounts for.
  Eigen::MatrixXd jacobian() {
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    options.parameter_blocks.push_back(camera.data());
    for (PoseChange& pose : poses) options.parameter_blocks.push_back(pose.data());
    return denseJacobian(problem, options);
  }
};

/// Length of an observation's residual in sigmas under the adjusted camera.
std::optional<double> residualOf(const CameraCalibration& result, std::size_t view,
                                 const PointObservation& observation) {
  const PoseChange none{};
  const CameraChange same{};
  std::array<double, 2> residual{};
  if (!Residual{&result.camera, &result.camera_from_station[view], &observation}(
          same.data(), none.data(), residual.data()))
    return std::nullopt;
  return std::hypot(residual[0], residual[1]);
}

/// Of the adjusted camera.
void measureResiduals(std::span<const CalibrationView> views, CameraCalibration& result) {
  NoiseMeter noise(kLossSigmas);
  double squares_px2 = 0.0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const PointObservation& observation : views[v].points) {
      const auto residual = residualOf(result, v, observation);
      if (!residual) continue;
      noise.add(*residual * *residual, observation.normal.isZero(0.0) ? 2 : 1);
      squares_px2 += *residual * *residual * observation.sigma_px * observation.sigma_px;
      ++count;
    }
  if (count > 0) result.rms_px = std::sqrt(squares_px2 / static_cast<double>(count));
  result.noise_factor = noise.noiseFactor(result.degrees_of_freedom);
}

std::vector<OutlyingView> outlyingViews(std::span<const CalibrationView> views,
                                        const CameraCalibration& result) {
  const double limit_sigmas = kFarOut_sigmas * std::max(1.0, result.noise_factor);
  std::vector<OutlyingView> outlying;
  for (std::size_t v = 0; v < views.size(); ++v) {
    OutlyingView view{views[v].case_id, 0, static_cast<int>(views[v].points.size()), 0.0};
    for (const PointObservation& observation : views[v].points) {
      const double residual = residualOf(result, v, observation).value_or(0.0);
      if (residual <= limit_sigmas) continue;
      ++view.far_out;
      view.largest_px = std::max(view.largest_px, residual * observation.sigma_px);
    }
    if (view.far_out > 0) outlying.push_back(view);
  }
  std::ranges::stable_sort(outlying, std::ranges::greater(), &OutlyingView::largest_px);
  return outlying;
}

}  // namespace

std::string outlyingText(const OutlyingView& view) {
  return view.case_id + ": " + std::to_string(view.far_out) + " of " +
         std::to_string(view.observations) + " observations are far out, by up to " +
         fixedText(view.largest_px, 1) + " px: check for swapped pairs";
}

std::optional<StatedCalibration> CameraCalibration::sigma(const StatedCalibration& former) const {
  StatedCalibration stated = former;
  for (const CalibrationParameter& parameter : parameters) {
    if (parameter.name == "focal_relative") stated.focal_relative = parameter.sigma;
    if (parameter.name == "centre_x_px") stated.principal_point_px = parameter.sigma;
    if (parameter.name == "centre_y_px")
      stated.principal_point_px =
          std::max(stated.principal_point_px.value_or(0.0), parameter.sigma);
  }
  const bool known = std::isfinite(stated.focal_relative.value_or(0.0)) &&
                     std::isfinite(stated.principal_point_px.value_or(0.0));
  if (!known || stated == StatedCalibration()) return std::nullopt;
  return stated;
}

CameraCalibration calibrateCamera(const Camera& camera, std::span<const CalibrationView> views,
                                  const FreeParameters& free) {
  const std::vector<int> indices = freeIndices(camera, free);
  if (indices.empty()) throw std::invalid_argument("no parameter of the camera is free");
  if (views.empty()) throw std::invalid_argument("there are no images with observations");
  Adjustment adjustment(camera, views, indices);
  CameraCalibration result;
  result.degrees_of_freedom = adjustment.observations - static_cast<int>(indices.size()) -
                              6 * static_cast<int>(views.size());
  if (result.degrees_of_freedom < 0)
    throw std::invalid_argument("there are fewer observations than unknowns");
  adjustment.solve();
  if (!changedCamera(camera, adjustment.camera.data(), result.camera))
    throw std::runtime_error("the adjusted camera cannot project; free less of it");
  for (std::size_t v = 0; v < views.size(); ++v)
    result.camera_from_station.push_back(perturbed(
        Eigen::Map<const Vector6d>(adjustment.poses[v].data()), views[v].camera_from_station));
  for (const int index : indices)
    result.parameters.push_back(parameterOf(index, result.camera, adjustment.camera));
  measureResiduals(views, result);
  result.outlying = outlyingViews(views, result);
  const double noise = std::max(1.0, result.noise_factor);
  const Eigen::MatrixXd information =
      reducedInformation(adjustment.jacobian(), static_cast<Eigen::Index>(indices.size())) /
      (noise * noise);
  result.covariance = judgeInformation(information, result.parameters, result.undetermined);
  return result;
}

CameraCalibration calibrateCameraOf(const Session& session, const std::string& case_id,
                                    ObservationSource source, const FreeParameters& free) {
  const Camera camera = knownCase(session, case_id).camera;
  Session same = session;
  same.cases.eraseIf([&camera](const auto& other) { return !(other->camera == camera); });
  return calibrateCamera(camera, observationsOf(same, source), free);
}

Session withCalibration(const Session& session, const std::string& case_id,
                        const CameraCalibration& calibration) {
  const Camera camera = knownCase(session, case_id).camera;
  Session next = session;
  for (const auto& session_case : session.cases) {
    if (!(session_case->camera == camera)) continue;
    SessionCase changed = *session_case;
    changed.camera = calibration.camera;
    changed.camera_covariance.reset();  // that of the former camera
    changed.calibration_sigma = calibration.sigma(InputSigmas(*session_case).stated);
    next = withCase(next, std::move(changed));
  }
  return next;
}

}  // namespace boresight::sessions
