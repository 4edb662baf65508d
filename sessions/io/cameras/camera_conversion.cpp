// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_conversion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "core/base/math.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr int kFitSteps = 48;           ///< along each side of the grid that is fitted
constexpr int kCheckedSteps = 256;      ///< along each side of the finer one that is checked
constexpr int kMostEvaluations = 4000;  ///< of all residuals, in one fit
constexpr double kFar_m = 1e6;          ///< 1 um of pupil is 1e-9 px there
constexpr double kWithoutLimit = 1e3;
constexpr std::size_t kFewestSights = 16;
/// A unit of a coefficient weighs as much as one residual of this size: numerator and denominator
/// of the rational model could else grow together without end, and their zeros meet the image.
constexpr double kRidge_px = 0.05;
constexpr int kPolynomialCount = 5;  ///< k1 k2 p1 p2 k3: no denominator
/// A fit begins with the points up to the first of these angles off the axis, in degrees, and goes
/// on from there with those up to the next one: (x/z, y/z) has its pole at 90 deg, and points close
/// to it, whose powers outweigh all others, would first pull the coefficients anywhere.
constexpr double kFieldAngles_deg[] = {60.0, 75.0, 84.0, 87.5, 89.0};
/// A pixel that the fitted camera does not see counts as one that it sees this far off: of two fits
/// the one with the smaller mean square is better.
constexpr double kUnseen_px = 20.0;

/// A pixel of the given camera and a point that it sees.
struct Sight {
  Eigen::Vector2d pixel;
  Eigen::Vector3d point_m;

  /// Tangent of the angle between the point and the axis.
  double tangent() const { return point_m.head<2>().norm() / point_m.z(); }
};

/// The point of a pixel's ray at a distance from the camera's centre; empty without a ray.
std::optional<Sight> sightAt(const Camera& camera, const Eigen::Vector2d& pixel,
                             double distance_m) {
  Ray ray;
  if (!unprojectRay(camera, pixel, ray)) return std::nullopt;
  const Eigen::Vector3d direction = ray.direction.normalized();
  const double along = ray.origin_m.dot(direction);
  const double square = along * along - ray.origin_m.squaredNorm() + distance_m * distance_m;
  if (square <= 0.0) return std::nullopt;
  const Sight sight{pixel, ray.origin_m + (std::sqrt(square) - along) * direction};
  return sight.point_m.z() > 0.0 ? std::optional(sight) : std::nullopt;
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

/// Points that a grid of pixels sees at a distance.
std::vector<Sight> sightsOf(const Camera& given, double distance_m) {
  std::vector<Sight> sights;
  for (const Eigen::Vector2d& pixel : pixelGrid(given, kFitSteps))
    if (const auto sight = sightAt(given, pixel, distance_m)) sights.push_back(*sight);
  return sights;
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
    // Without the limit of the valid field: prepareCamera checks the fitted camera.
    camera.valid_radius = kWithoutLimit;
    for (std::size_t i = 0; i < sights->size(); ++i) {
      Eigen::Vector2d pixel;
      const Sight& sight = (*sights)[i];
      // Only a step towards a pole of the model; the solver takes it back.
      const bool seen = project(camera, sight.point_m, pixel) && pixel.allFinite();
      residuals.segment<2>(static_cast<Eigen::Index>(2 * i)) =
          seen ? Eigen::Vector2d(pixel - sight.pixel) : Eigen::Vector2d::Constant(1e6);
    }
    const double ridge_px = parameter_count - 4 > kPolynomialCount ? kRidge_px : 0.0;
    residuals.tail(parameter_count - 4) = ridge_px * parameters.tail(parameter_count - 4);
    return 0;
  }
};

bool fitParameters(const std::vector<Sight>& sights, int coefficient_count, Camera& camera) {
  Eigen::VectorXd parameters(4 + coefficient_count);
  parameters.head<4>() << camera.fx, camera.fy, camera.cx, camera.cy;
  for (int i = 0; i < coefficient_count; ++i)
    parameters[4 + i] = camera.distortion[static_cast<std::size_t>(i)];
  const Camera start = camera;
  Eigen::NumericalDiff<FitResiduals, Eigen::Central> residuals(
      FitResiduals{&start, &sights, static_cast<int>(parameters.size())});
  Eigen::LevenbergMarquardt<decltype(residuals)> solver(residuals);
  solver.parameters.maxfev = kMostEvaluations;
  solver.parameters.xtol = solver.parameters.ftol = 1e-13;
  solver.minimize(parameters);
  camera = cameraOf(start, parameters);
  return parameters.allFinite() && prepareCamera(camera) == Status::kOk;
}

/// Measures the errors of a fitted camera.
class FitCheck {
 public:
  FitCheck(const Camera& given, double distance_m) {
    for (const Eigen::Vector2d& pixel : checkedPixels(given)) {
      const auto near = sightAt(given, pixel, distance_m);
      if (!near) {
        ++without_ray_count_;
        continue;
      }
      near_.push_back(*near);
      if (const auto far = sightAt(given, pixel, kFar_m)) far_.push_back(*far);
    }
  }

  FittedCamera measured(const Camera& camera) const {
    FittedCamera fitted;
    fitted.camera = camera;
    fitted.without_ray_count = without_ray_count_;
    fitted.checked_count = without_ray_count_ + static_cast<int>(near_.size());
    double squares = 0.0;
    for (const Sight& sight : near_) {
      const auto error_px = errorOf(camera, sight);
      if (!error_px) {
        ++fitted.unseen_count;
        continue;
      }
      squares += *error_px * *error_px;
      if (*error_px <= fitted.worst_error_px) continue;
      fitted.worst_error_px = *error_px;
      fitted.worst_pixel = sight.pixel;
    }
    const auto seen_count = static_cast<int>(near_.size()) - fitted.unseen_count;
    fitted.rms_error_px = std::sqrt(squares / std::max(1, seen_count));
    return fitted;
  }

  void measureFar(FittedCamera& fitted) const {
    for (const Sight& sight : far_)
      fitted.worst_error_far_px =
          std::max(fitted.worst_error_far_px, errorOf(fitted.camera, sight).value_or(0.0));
  }

 private:
  static std::optional<double> errorOf(const Camera& camera, const Sight& sight) {
    Eigen::Vector2d found;
    if (!project(camera, sight.point_m, found)) return std::nullopt;
    return (found - sight.pixel).norm();
  }

  std::vector<Sight> near_, far_;
  int without_ray_count_ = 0;
};

/// Mean square over all pixels that have a ray, the unseen ones included.
double costOf(const FittedCamera& fitted) {
  const int with_ray = fitted.checked_count - fitted.without_ray_count;
  const int seen = with_ray - fitted.unseen_count;
  return (fitted.rms_error_px * fitted.rms_error_px * seen +
          kUnseen_px * kUnseen_px * fitted.unseen_count) /
         std::max(1, with_ray);
}

/// Whether more coefficients are worth it: the worst error falls by a tenth and 0.001 px.
bool isBetter(const FittedCamera& longer, const FittedCamera& shorter) {
  if (longer.unseen_count != shorter.unseen_count) return costOf(longer) < costOf(shorter);
  return longer.worst_error_px < 0.9 * shorter.worst_error_px - 1e-3;
}

/// Points that a camera sees up to an angle off the axis.
struct Field {
  double widest_rad = 0.0;
  std::vector<Sight> sights;
};

/// Ever larger ones; the last is all that a model can be fitted to.
std::vector<Field> growingFields(const std::vector<Sight>& sights, CameraModel model) {
  std::vector<Field> fields;
  const auto add = [&](double limit) {
    Field field{std::atan(limit), {}};
    std::copy_if(sights.begin(), sights.end(), std::back_inserter(field.sights),
                 [limit](const Sight& sight) { return sight.tangent() < limit; });
    const std::size_t before = fields.empty() ? kFewestSights - 1 : fields.back().sights.size();
    if (field.sights.size() > before) fields.push_back(std::move(field));
  };
  for (const double angle_deg : kFieldAngles_deg) add(std::tan(angle_deg * kDegree_rad));
  add(model == CameraModel::kBrownConrady ? kWithoutLimit
                                          : std::numeric_limits<double>::infinity());
  return fields;
}

/// Distorted radius of an angle, z = 1.
double distortedRadius(const Camera& kannala_brandt, double theta) {
  const double square = theta * theta;
  double factor = 0.0;
  for (std::size_t i = 4; i-- > 0;) factor = (factor + kannala_brandt.distortion[i]) * square;
  return theta * (1.0 + factor);
}

/// A Brown-Conrady camera with all six radial coefficients that distorts radially as a
/// Kannala-Brandt camera does, up to an angle off the axis (rad, less than 90 deg): a start for
/// fits of wide fields, where from no distortion at all the zeros of numerator and denominator soon
/// meet within the image. fx fy cx cy and the size are kept; not prepared. (Linear least squares,
/// weighted with the denominator of the round before: Sanathanan and Koerner, "Transfer function
/// synthesis as a ratio of two complex polynomials", 1963.)
Camera rationalStart(const Camera& kannala_brandt, double widest_rad) {
  constexpr int kAngles = 200;
  constexpr int kRounds = 8;
  // With s = tan^2 theta and g the factor of the radius: N(s) - g D(s) = 0, linear in k1 .. k6.
  Eigen::MatrixXd rows(kAngles, 6);
  Eigen::VectorXd right(kAngles), square(kAngles), radius(kAngles);
  for (int i = 0; i < kAngles; ++i) {
    const double theta = widest_rad * (i + 1) / kAngles;
    const double r = std::tan(theta);
    const double s = r * r;
    const double factor = distortedRadius(kannala_brandt, theta) / r;
    const Eigen::RowVector3d powers(s, s * s, s * s * s);
    rows.row(i) << powers, -factor * powers;
    right[i] = factor - 1.0;
    square[i] = s;
    radius[i] = r;
  }
  Eigen::VectorXd denominator = Eigen::VectorXd::Ones(kAngles);
  Eigen::VectorXd k = Eigen::VectorXd::Zero(6);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd weight = radius.cwiseQuotient(denominator.cwiseAbs());
    Eigen::MatrixXd weighted = weight.asDiagonal() * rows;
    const Eigen::VectorXd length = weighted.colwise().norm();
    weighted = weighted * length.cwiseInverse().asDiagonal();
    k = weighted.colPivHouseholderQr().solve(weight.cwiseProduct(right)).cwiseQuotient(length);
    const auto s = square.array();
    denominator = 1.0 + s * (k[3] + s * (k[4] + s * k[5]));
  }
  Camera camera = kannala_brandt;
  camera.model = CameraModel::kBrownConrady;
  camera.distortion = {k[0], k[1], 0.0, 0.0, k[2], k[3], k[4], k[5]};
  return camera;
}

/// The best of some fits, where there is one.
using BestFit = std::optional<FittedCamera>;

void offer(const FittedCamera& fitted, BestFit& best) {
  if (!best || costOf(fitted) < costOf(*best)) best = fitted;
}

/// The best fits to growing fields, for each number of coefficients. Each starts from the fit of
/// the field before; with more coefficients than the polynomial's also from the polynomial, and in
/// a wide field from what distorts like `equidistant` (a fitted Kannala-Brandt camera), where there
/// is one.
std::vector<BestFit> fitGrowing(const Camera& start, const std::vector<Field>& fields,
                                std::span<const int> counts, const FitCheck& check,
                                const BestFit& equidistant) {
  std::vector<BestFit> best(counts.size());
  std::vector<Camera> reached(counts.size(), start);
  for (const Field& field : fields)
    for (std::size_t i = 0; i < counts.size(); ++i) {
      BestFit best_fit;
      const auto fitFrom = [&](Camera camera) {
        if (fitParameters(field.sights, counts[i], camera)) offer(check.measured(camera), best_fit);
      };
      fitFrom(reached[i]);
      if (i > 0) fitFrom(reached[i - 1]);
      if (i > 0 && equidistant) fitFrom(rationalStart(equidistant->camera, field.widest_rad));
      if (!best_fit) continue;
      reached[i] = best_fit->camera;
      offer(*best_fit, best[i]);
    }
  return best;
}

/// Fits of a model, with each number of coefficients.
std::vector<BestFit> fitsOf(const Camera& given, CameraModel model,
                            const std::vector<Sight>& sights, const FitCheck& check) {
  const std::vector<Field> fields = growingFields(sights, model);
  BestFit equidistant;
  if (model == CameraModel::kBrownConrady && fields.size() > 1)
    equidistant = fitsOf(given, CameraModel::kKannalaBrandt, sights, check).front();
  Camera start = given;
  start.model = model;
  start.distortion = {};
  start.cahv = {};
  return fitGrowing(start, fields, coefficientCounts(model), check, equidistant);
}

}  // namespace

FittedCamera fitCamera(const Camera& given, CameraModel model, double distance_m) {
  if (isCahvFamily(model))
    throw std::invalid_argument("fitCamera: a model of the CAHV family is not fitted");
  if (isMirrored(given))
    throw std::runtime_error("its image is mirrored, which only vector models can state");
  distance_m = std::min(distance_m, kFar_m);
  const std::vector<Sight> sights = sightsOf(given, distance_m);
  if (sights.size() < kFewestSights)
    throw std::runtime_error("hardly any pixel sees a point at that distance");
  const FitCheck check(given, distance_m);
  BestFit best;
  for (const BestFit& best_fit : fitsOf(given, model, sights, check))
    if (best_fit && (!best || isBetter(*best_fit, *best))) best = best_fit;
  if (!best)
    throw std::runtime_error(std::string("no ") + cameraModelName(model) +
                             " camera approximates it");
  check.measureFar(*best);
  return *best;
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
    text += "; " + share(fitted.without_ray_count) + " of the image have no ray";
  return text;
}

void writeFittedCamera(const std::filesystem::path& file, const FittedCamera& fitted,
                       const CameraFile& given, const std::string& given_name, double distance_m) {
  nlohmann::ordered_json json = {{"format", "boresight-camera"}, {"version", 1}};
  json.update(toJson(CameraFile{fitted.camera, std::nullopt, statedCalibration(given)}));
  nlohmann::ordered_json from = {{"file", given_name},
                                 {"model", cameraModelName(given.camera.model)},
                                 {"worst_error_px", fitted.worst_error_px},
                                 {"rms_error_px", fitted.rms_error_px}};
  if (std::isfinite(distance_m)) {
    from["distance_m"] = distance_m;
    from["worst_error_far_px"] = fitted.worst_error_far_px;
  }
  json["fitted_from"] = from;
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
