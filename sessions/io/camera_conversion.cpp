// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/camera_conversion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "sessions/io/camera_file.h"
#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr int kFitSteps = 48;       ///< along each side of the grid that is fitted
constexpr int kCheckedSteps = 256;  ///< along each side of the finer one that is checked
constexpr double kFar_m = 1e6;      ///< 1 um of pupil is 1e-9 px there
constexpr double kWithoutLimit = 1e3;
/// A unit of a coefficient weighs as much as one residual of this size: numerator and denominator
/// of the rational model could else grow together without end, and their zeros meet the image.
constexpr double kRidge_px = 0.05;
constexpr int kPolynomialCount = 5;  ///< k1 k2 p1 p2 k3: no denominator

/// A pixel of the given camera and a point that it sees.
struct Sight {
  Eigen::Vector2d pixel;
  Eigen::Vector3d point_m;
};

/// The point of a pixel's ray at a distance from the camera's centre; false without a ray.
bool sightAt(const Camera& camera, const Eigen::Vector2d& pixel, double distance_m, Sight& sight) {
  Ray ray;
  if (!unprojectRay(camera, pixel, ray)) return false;
  const Eigen::Vector3d direction = ray.direction.normalized();
  const double along = ray.origin_m.dot(direction);
  const double square = along * along - ray.origin_m.squaredNorm() + distance_m * distance_m;
  if (square <= 0.0) return false;
  sight = {pixel, ray.origin_m + (std::sqrt(square) - along) * direction};
  return sight.point_m.z() > 0.0;
}

std::vector<double> placesAlong(int side, int steps) {
  const int count = std::min(side, steps + 1);
  std::vector<double> places;
  for (int i = 0; i < count; ++i)
    places.push_back(count == 1 ? 0.0
                                : std::floor(static_cast<double>(side - 1) * i / (count - 1)));
  return places;
}

std::vector<Eigen::Vector2d> pixelGrid(const Camera& camera, int steps) {
  std::vector<Eigen::Vector2d> pixels;
  for (const double y : placesAlong(camera.height, steps))
    for (const double x : placesAlong(camera.width, steps)) pixels.emplace_back(x, y);
  return pixels;
}

/// The grid and every pixel of the border, where errors are largest.
std::vector<Eigen::Vector2d> checkedPixels(const Camera& camera) {
  std::vector<Eigen::Vector2d> pixels = pixelGrid(camera, kCheckedSteps);
  for (int x = 0; x < camera.width; ++x)
    for (const int y : {0, camera.height - 1}) pixels.emplace_back(x, y);
  for (int y = 0; y < camera.height; ++y)
    for (const int x : {0, camera.width - 1}) pixels.emplace_back(x, y);
  return pixels;
}

/// fx fy cx cy and coefficients, as a vector to be fitted.
Camera cameraOf(const Camera& start, const Eigen::VectorXd& parameters) {
  Camera camera = start;
  camera.fx = parameters[0];
  camera.fy = parameters[1];
  camera.cx = parameters[2];
  camera.cy = parameters[3];
  for (int i = 4; i < parameters.size(); ++i)
    camera.distortion[static_cast<std::size_t>(i - 4)] = parameters[i];
  return camera;
}

/// Residuals in pixels, for Eigen's port of MINPACK.
struct FitResiduals {
  using Scalar = double;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;

  const Camera* start;
  const std::vector<Sight>* sights;
  int parameter_count;

  int inputs() const { return parameter_count; }
  int values() const { return static_cast<int>(2 * sights->size()) + parameter_count - 4; }

  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals) const {
    Camera camera = cameraOf(*start, parameters);
    // The formula alone counts here; whether it folds back is asked of the camera that comes out.
    camera.valid_radius = kWithoutLimit;
    for (std::size_t i = 0; i < sights->size(); ++i) {
      Eigen::Vector2d pixel;
      const Sight& sight = (*sights)[i];
      const bool seen = project(camera, sight.point_m, pixel) && pixel.allFinite();
      residuals.segment<2>(static_cast<Eigen::Index>(2 * i)) =
          seen ? Eigen::Vector2d(pixel - sight.pixel) : Eigen::Vector2d::Constant(1e6);
    }
    const double ridge_px = parameter_count - 4 > kPolynomialCount ? kRidge_px : 0.0;
    residuals.tail(parameter_count - 4) = ridge_px * parameters.tail(parameter_count - 4);
    return 0;
  }
};

Camera startCamera(const Camera& given, CameraModel model) {
  Camera camera;
  camera.model = model;
  camera.width = given.width;
  camera.height = given.height;
  camera.fx = given.fx;
  camera.fy = given.fy;
  camera.cx = given.cx;
  camera.cy = given.cy;
  return camera;
}

bool fitParameters(const std::vector<Sight>& sights, int coefficient_count, Camera& camera) {
  Eigen::VectorXd parameters(4 + coefficient_count);
  parameters.head<4>() << camera.fx, camera.fy, camera.cx, camera.cy;
  for (int i = 0; i < coefficient_count; ++i)
    parameters[4 + i] = camera.distortion[static_cast<std::size_t>(i)];
  const Camera start = camera;
  Eigen::NumericalDiff<FitResiduals, Eigen::Central> residuals(
      FitResiduals{&start, &sights, static_cast<int>(parameters.size())});
  Eigen::LevenbergMarquardt<decltype(residuals)> solver(residuals);
  solver.parameters.maxfev = 4000;
  solver.parameters.xtol = solver.parameters.ftol = 1e-13;
  solver.minimize(parameters);
  camera = cameraOf(start, parameters);
  return parameters.allFinite() && prepareCamera(camera) == Status::kOk;
}

void measure(const Camera& given, double distance_m, FittedCamera& fitted) {
  double squares = 0.0;
  int seen_count = 0;
  for (const Eigen::Vector2d& pixel : checkedPixels(given)) {
    ++fitted.checked_count;
    Sight sight;
    Eigen::Vector2d found;
    if (!sightAt(given, pixel, distance_m, sight)) {
      ++fitted.without_ray_count;
      continue;
    }
    if (!project(fitted.camera, sight.point_m, found)) {
      ++fitted.unseen_count;
      continue;
    }
    const double error_px = (found - pixel).norm();
    squares += error_px * error_px;
    ++seen_count;
    if (error_px > fitted.worst_error_px) {
      fitted.worst_error_px = error_px;
      fitted.worst_pixel = pixel;
    }
    if (sightAt(given, pixel, kFar_m, sight) && project(fitted.camera, sight.point_m, found))
      fitted.worst_error_far_px = std::max(fitted.worst_error_far_px, (found - pixel).norm());
  }
  fitted.rms_error_px = std::sqrt(squares / std::max(1, seen_count));
}

/// How many coefficients are tried; 0 of a pinhole.
std::vector<int> coefficientCounts(CameraModel model) {
  if (model == CameraModel::kPinhole) return {0};
  if (model == CameraModel::kKannalaBrandt) return {4};
  return {kPolynomialCount, 8};
}

/// Whether more coefficients pay: by a thousandth of a pixel and a tenth.
bool isBetter(const FittedCamera& longer, const FittedCamera& shorter) {
  if (longer.unseen_count != shorter.unseen_count)
    return longer.unseen_count < shorter.unseen_count;
  return longer.worst_error_px < 0.9 * shorter.worst_error_px - 1e-3;
}

std::vector<Sight> sightsOf(const Camera& given, double distance_m) {
  std::vector<Sight> sights;
  Sight sight;
  for (const Eigen::Vector2d& pixel : pixelGrid(given, kFitSteps))
    if (sightAt(given, pixel, distance_m, sight)) sights.push_back(sight);
  return sights;
}

std::string threeDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

FittedCamera fitCamera(const Camera& given, CameraModel model, double distance_m) {
  if (isCahvFamily(model))
    throw std::invalid_argument("fitCamera: a model of the CAHV family is not fitted");
  if (isMirrored(given))
    throw std::runtime_error("its image is mirrored, which no model without vectors can say");
  distance_m = std::min(distance_m, kFar_m);
  const std::vector<Sight> sights = sightsOf(given, distance_m);
  if (sights.size() < 16)
    throw std::runtime_error("hardly a pixel of it sees a point at that distance");
  FittedCamera best;
  bool found = false;
  Camera start = startCamera(given, model);
  for (const int count : coefficientCounts(model)) {
    FittedCamera fitted;
    fitted.camera = start;
    if (!fitParameters(sights, count, fitted.camera)) continue;
    start = fitted.camera;
    measure(given, distance_m, fitted);
    if (!found || isBetter(fitted, best)) best = fitted;
    found = true;
  }
  if (!found)
    throw std::runtime_error(std::string("no ") + cameraModelName(model) +
                             " camera comes near to it");
  return best;
}

std::string fitText(const FittedCamera& fitted) {
  std::string text = "worst error " + threeDigits(fitted.worst_error_px) + " px at (" +
                     numberText(fitted.worst_pixel.x()) + ", " +
                     numberText(fitted.worst_pixel.y()) + "), rms " +
                     threeDigits(fitted.rms_error_px) + " px";
  const auto share = [&fitted](int count) {
    return threeDigits(100.0 * count / fitted.checked_count) + " %";
  };
  if (fitted.unseen_count > 0)
    text += "; " + share(fitted.unseen_count) + " of the image lie outside its valid field";
  if (fitted.without_ray_count > 0)
    text += "; " + share(fitted.without_ray_count) + " of the image had no ray to begin with";
  return text;
}

void writeFittedCamera(const std::filesystem::path& file, const FittedCamera& fitted,
                       const Camera& given, const std::string& given_name, double distance_m) {
  nlohmann::ordered_json json = {{"format", "boresight-camera"}, {"version", 1}};
  json.update(toJson(fitted.camera));
  nlohmann::ordered_json from = {{"file", given_name}, {"model", cameraModelName(given.model)}};
  from["worst_error_px"] = fitted.worst_error_px;
  from["rms_error_px"] = fitted.rms_error_px;
  if (std::isfinite(distance_m)) {
    from["distance_m"] = distance_m;
    from["worst_error_far_px"] = fitted.worst_error_far_px;
  }
  json["fitted_from"] = from;
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
