// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_covariance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr Eigen::Index kA = 3, kH = 6, kV = 9, kO = 12;

CameraCovariance mapped(const Eigen::MatrixXd& by, const CameraCovariance& covariance) {
  const Eigen::MatrixXd product = by * covariance.of_vectors * by.transpose();
  return {0.5 * (product + product.transpose())};
}

/// Small against any lens and large against rounding: m, 1 and px.
double halfStep(Eigen::Index component) {
  const bool in_pixels = component >= kH && component < kO;
  return in_pixels ? 1e-3 : 1e-6;
}

bool displaced(const Camera& camera, Eigen::Index component, double step, DisplacedCamera& to) {
  CahvModel vectors = cahvFromCamera(camera, Pose());
  Eigen::Index first = 0;
  forVectors(vectors, [&](const char*, Eigen::Vector3d& vector) {
    if (component >= first && component < first + 3) vector[component - first] += step;
    first += 3;
  });
  return cameraFromCahv(vectors, camera.width, camera.height, to.camera,
                        to.displaced_from_camera) == Status::kOk;
}

/// Standard deviation of a parameter of the camera.
double sigmaOf(const std::vector<VectorStep>& steps, const CameraCovariance& covariance,
               double Camera::*parameter) {
  Eigen::VectorXd by(static_cast<Eigen::Index>(steps.size()));
  for (std::size_t i = 0; i < steps.size(); ++i)
    by[static_cast<Eigen::Index>(i)] =
        (steps[i].after.camera.*parameter - steps[i].before.camera.*parameter) / steps[i].width;
  return std::sqrt(std::max(0.0, by.dot(covariance.of_vectors * by)));
}

}  // namespace

int vectorComponents(CameraModel model) {
  if (!isCahvFamily(model)) return 0;
  return model == CameraModel::kCahv ? 12 : model == CameraModel::kCahvor ? 18 : 21;
}

CameraCovariance inFrame(const CameraCovariance& in_b, const Pose& a_from_b) {
  if (a_from_b == Pose()) return in_b;
  const Eigen::Index size = in_b.of_vectors.rows();
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(size, size);
  for (const Eigen::Index vector : {Eigen::Index{0}, kA, kH, kV, kO})
    if (vector + 3 <= size) turn.block<3, 3>(vector, vector) = a_from_b.matrix();
  return mapped(turn, in_b);
}

CameraCovariance ofSubframe(const CameraCovariance& whole, double shift_h_px, double shift_v_px,
                            double scale) {
  const Eigen::Index size = whole.of_vectors.rows();
  Eigen::MatrixXd cut = Eigen::MatrixXd::Identity(size, size);
  cut.block<3, 3>(kH, kH) = cut.block<3, 3>(kV, kV) = Eigen::Matrix3d::Identity() / scale;
  cut.block<3, 3>(kH, kA) = Eigen::Matrix3d::Identity() * (shift_h_px / scale);
  cut.block<3, 3>(kV, kA) = Eigen::Matrix3d::Identity() * (shift_v_px / scale);
  return mapped(cut, whole);
}

CameraCovariance readCameraCovariance(const JsonReader& json, CameraModel model) {
  const int size = vectorComponents(model);
  if (size == 0) json.fail("only a camera of the CAHV family has a covariance of its vectors");
  const std::string shape = std::to_string(size) + " rows of as many numbers are needed";
  const std::vector<JsonReader> rows = json.elements();
  if (std::ssize(rows) != size) json.fail(shape);
  CameraCovariance covariance{Eigen::MatrixXd(size, size)};
  for (int i = 0; i < size; ++i) {
    const std::vector<JsonReader> row = rows[static_cast<std::size_t>(i)].elements();
    if (std::ssize(row) != size) json.fail(shape);
    for (int j = 0; j < size; ++j)
      covariance.of_vectors(i, j) = row[static_cast<std::size_t>(j)].number(-1e18, 1e18);
  }
  if (!isCovariance(covariance.of_vectors)) json.fail("is " + std::string(kNoCovariance));
  return covariance;
}

nlohmann::ordered_json toJson(const CameraCovariance& covariance) {
  return toJson(covariance.of_vectors);
}

std::vector<VectorStep> vectorSteps(const Camera& camera) {
  std::vector<VectorStep> steps(static_cast<std::size_t>(vectorComponents(camera.model)));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto component = static_cast<Eigen::Index>(i);
    const double half = halfStep(component);
    steps[i].width = 2.0 * half;
    if (!displaced(camera, component, -half, steps[i].before) ||
        !displaced(camera, component, half, steps[i].after))
      return {};
  }
  return steps;
}

CalibrationSigma calibrationSigmaOf(const Camera& camera, const CameraCovariance& covariance) {
  const std::vector<VectorStep> steps = vectorSteps(camera);
  if (steps.empty()) return {};
  const auto sigma = [&](double Camera::*parameter) {
    return sigmaOf(steps, covariance, parameter);
  };
  const double focal =
      std::max(sigma(&Camera::fx) / camera.fx, sigma(&Camera::fy) / std::abs(camera.fy));
  const double centre_px = std::max(sigma(&Camera::cx), sigma(&Camera::cy));
  return {std::min(focal, kMaxFocalSigma), std::min(centre_px, kMaxPrincipalPointSigma_px)};
}

}  // namespace boresight::sessions
