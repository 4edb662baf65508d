// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/solve_annotations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/first_poses.h"
#include "sessions/annotation/geometry_meter.h"

namespace boresight::sessions {
namespace {

constexpr int kPoseUnknowns = 6;
constexpr int kRobustRounds = 50;
constexpr double kTukey = 4.685;  ///< 95 % efficient on Gaussian errors
/// Of |residual| / sigma of a two-dimensional Gaussian: its median is 1.1774.
constexpr double kMedianOfRayleigh = 1.1774;
constexpr double kAmbiguousRatio = 5.0;       ///< of both poses' rms, or the other one is ruled out
constexpr double kAmbiguousFloor_px = 1.0;    ///< rms below this is never ruled out
constexpr double kAmbiguousAngle_rad = 0.02;  ///< nearer than this it is the same pose

/// By the points of the view that has the most of them, rig from station.
std::vector<Pose> startsOf(std::span<const AnnotatedView> views) {
  const auto count = [](const AnnotatedView& view) {
    return std::ranges::count_if(view.annotations.points, &PointPair::used);
  };
  const auto most = std::ranges::max_element(views, {}, count);
  if (most == views.end()) return {};
  std::vector<Pose> poses = firstPoses(*most);
  for (Pose& pose : poses) pose = most->camera_from_rig.inverse() * pose;
  return poses;
}

/// The other pose that a plane of annotations may have: its normal mirrored about the line of sight
/// (Schweighofer and Pinz, "Robust Pose Estimation from a Planar Target", PAMI 2006). Nothing where
/// the annotations do not lie in a plane.
std::optional<Pose> mirroredPose(std::span<const AnnotatedView> views,
                                 const Pose& rig_from_station) {
  const AnnotatedSpread spread = annotatedSpread(views);
  if (!spread.coplanar()) return {};
  const Pose camera_from_station = views.front().camera_from_rig * rig_from_station;
  const Eigen::Vector3d sight = (camera_from_station * spread.middle_in_station_m).normalized();
  Eigen::Vector3d normal = camera_from_station.rotation * spread.axes_in_station.col(2);
  if (normal.dot(sight) > 0.0) normal = -normal;
  const Eigen::Vector3d mirrored = 2.0 * normal.dot(sight) * sight - normal;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(normal, mirrored);
  Pose mirrored_camera_from_station;
  mirrored_camera_from_station.rotation = (turn * camera_from_station.rotation).normalized();
  mirrored_camera_from_station.translation_m =
      camera_from_station * spread.middle_in_station_m -
      mirrored_camera_from_station.rotation * spread.middle_in_station_m;
  return views.front().camera_from_rig.inverse() * mirrored_camera_from_station;
}

/// A pose and the squares that it leaves.
struct Fit {
  Pose rig_from_station;
  NormalEquations equations;
  std::vector<double> weight;  ///< one per annotation

  double weightSum() const { return std::accumulate(weight.begin(), weight.end(), 0.0); }
  double rms_px() const { return std::sqrt(equations.squares / std::max(1.0, 2.0 * weightSum())); }
};

std::vector<double> weightedNorms(std::span<const AnnotatedView> views,
                                  std::span<const AnnotationAddress> annotations,
                                  const Pose& pose) {
  std::vector<double> norms;
  for (const AnnotationAddress& at : annotations) {
    const AnnotatedView& view = views[at.view];
    const AnnotationResidual annotation = annotationResidual(view, at, view.camera_from_rig * pose);
    norms.push_back(annotation.valid ? annotation.residual_px.norm() / annotationSigma_px(views, at)
                                     : 1e9);
  }
  return norms;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Tukey's biweight; its scale is not taken below the annotations' own sigma.
std::vector<double> tukeyWeights(const std::vector<double>& norms) {
  const double limit = kTukey * std::max(1.0, medianOf(norms) / kMedianOfRayleigh);
  std::vector<double> weight;
  for (const double norm : norms) {
    const double ratio = std::min(1.0, norm / limit);
    weight.push_back((1.0 - ratio * ratio) * (1.0 - ratio * ratio));
  }
  return weight;
}

std::optional<Fit> fitFrom(std::span<const AnnotatedView> views,
                           std::span<const AnnotationAddress> annotations, const Pose& start,
                           bool robust) {
  Fit fit{start, {}, std::vector<double>(annotations.size(), 1.0)};
  if (!robust) {
    if (!refineAnnotations(views, annotations, fit.weight, fit.rig_from_station, fit.equations))
      return {};
    return fit;
  }
  // The start agrees with most annotations, so the first weights come from it.
  for (int round = 0; round < kRobustRounds; ++round) {
    const std::vector<double> before = fit.weight;
    fit.weight = tukeyWeights(weightedNorms(views, annotations, fit.rig_from_station));
    if (!refineAnnotations(views, annotations, fit.weight, fit.rig_from_station, fit.equations))
      return {};
    double change = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      change = std::max(change, std::abs(before[i] - fit.weight[i]));
    if (change < 1e-9) break;
  }
  return fit;
}

/// The better of what the starts lead to. Robust fits leave annotations out: the one with more left
/// wins.
std::optional<Fit> bestFit(std::span<const AnnotatedView> views,
                           std::span<const AnnotationAddress> annotations,
                           const SolveAnnotationsOptions& options) {
  std::optional<Fit> best;
  const auto cost = [](const Fit& fit) {
    double excluded = 0.0;
    for (const double weight : fit.weight) excluded += 1.0 - weight;
    return fit.equations.squares + 2.0 * kTukey * kTukey * excluded;
  };
  const auto consider = [&](const std::optional<Pose>& start) {
    if (!start) return;
    const std::optional<Fit> fit = fitFrom(views, annotations, *start, options.robust);
    if (fit && (!best || cost(*fit) < cost(*best))) best = fit;
  };
  for (const Pose& pose : startsOf(views)) consider(pose);
  consider(options.rig_from_station_guess);
  if (best) consider(mirroredPose(views, best->rig_from_station));
  return best;
}

std::optional<AmbiguousPose> ambiguousPoseOf(std::span<const AnnotatedView> views,
                                             std::span<const AnnotationAddress> annotations,
                                             const Fit& fit, bool robust) {
  const std::optional<Pose> start = mirroredPose(views, fit.rig_from_station);
  if (!start) return {};
  const std::optional<Fit> other = fitFrom(views, annotations, *start, robust);
  if (!other) return {};
  const Eigen::Quaterniond turn =
      (other->rig_from_station.rotation * fit.rig_from_station.rotation.conjugate()).normalized();
  if (rotationLog(turn).norm() < kAmbiguousAngle_rad) return {};
  if (other->rms_px() > std::max(kAmbiguousFloor_px, kAmbiguousRatio * fit.rms_px())) return {};
  return AmbiguousPose{other->rig_from_station, other->rms_px()};
}

/// Residual scaled by its own deviation: what an annotation pulls on the pose makes its residual
/// smaller (studentized; Cook and Weisberg 1982). Of a weight of 0 it pulls nothing, and the pose's
/// own deviation adds to its noise.
double normalizedResidual(const AnnotationResidual& annotation, const Matrix6d& camera_covariance,
                          double noise_px, double weight) {
  Eigen::Matrix2d variance = noise_px * noise_px * Eigen::Matrix2d::Identity() +
                             (1.0 - 2.0 * weight) * annotation.predicted_by_xi * camera_covariance *
                                 annotation.predicted_by_xi.transpose();
  // The residual of an annotation that alone determines the pose is nearly 0.
  for (int i = 0; i < 2; ++i) variance(i, i) = std::max(variance(i, i), 1e-4 * noise_px * noise_px);
  double largest = 0.0;
  for (int i = 0; i < 2; ++i)
    largest = std::max(largest, std::abs(annotation.residual_px[i]) / std::sqrt(variance(i, i)));
  return largest;
}

double pixelsPerRadian(const Camera& camera) { return 0.5 * (camera.fx + std::abs(camera.fy)); }

/// `inverse`: of the fit's information, (J' W J)^-1.
void describeAnnotations(std::span<const AnnotatedView> views,
                         std::span<const AnnotationAddress> annotations, const Fit& fit,
                         const Matrix6d& inverse, AnnotationsSolution& solution) {
  const double noise_factor = std::max(solution.noise_factor, 1e-6);
  for (std::size_t i = 0; i < annotations.size(); ++i) {
    const AnnotatedView& view = views[annotations[i].view];
    const AnnotationResidual annotation =
        annotationResidual(view, annotations[i], solution.camera_from_station[annotations[i].view]);
    SolvedAnnotation solved;
    solved.address = annotations[i];
    solved.weight = fit.weight[i];
    solved.projected = annotation.valid;
    if (annotation.valid) {
      solved.residual_px = annotation.residual_px;
      solved.residual_mm =
          annotation.residual_px * (1000.0 * annotation.depth_m / pixelsPerRadian(view.camera));
      solved.normalized = normalizedResidual(
          annotation, noise_factor * noise_factor * covarianceIn(view.camera_from_rig, inverse),
          noise_factor * annotationSigma_px(views, annotations[i]), solved.weight);
    }
    solution.annotations.push_back(solved);
  }
}

AnnotationsSolution describe(std::span<const AnnotatedView> views,
                             std::span<const AnnotationAddress> annotations, const Fit& fit,
                             bool robust) {
  AnnotationsSolution solution;
  solution.rig_from_station = fit.rig_from_station;
  for (const AnnotatedView& view : views)
    solution.camera_from_station.push_back(view.camera_from_rig * fit.rig_from_station);
  const double freedom = 2.0 * fit.weightSum() - kPoseUnknowns;
  solution.degrees_of_freedom = std::max(0, static_cast<int>(std::floor(freedom + 1e-9)));
  if (solution.degrees_of_freedom > 0)
    solution.noise_factor = std::sqrt(fit.equations.squares / freedom);
  Matrix6d inverse;
  if (!invert(fit.equations.information, inverse)) inverse.setZero();
  const double noise = std::max(1.0, solution.noise_factor);
  solution.covariance = noise * noise * inverse;
  describeAnnotations(views, annotations, fit, inverse, solution);
  double squares_px = 0.0;
  for (const SolvedAnnotation& annotation : solution.annotations)
    squares_px += annotation.weight * annotation.residual_px.squaredNorm();
  solution.rms_px = std::sqrt(squares_px / std::max(1.0, 2.0 * fit.weightSum()));
  solution.ambiguous = ambiguousPoseOf(views, annotations, fit, robust);
  return solution;
}

/// Why nothing can be solved, or "".
std::string hindrance(std::span<const AnnotatedView> views,
                      const SolveAnnotationsOptions& options) {
  const Pose* guess = options.rig_from_station_guess ? &*options.rig_from_station_guess : nullptr;
  for (const GeometryWarning& warning : geometryWarnings(views, guess, {}))
    if (warning.prevents) return warning.text;
  return "";
}

}  // namespace

AnnotationsResult solveAnnotations(std::span<const AnnotatedView> views,
                                   const SolveAnnotationsOptions& options) {
  const std::string hindered = hindrance(views, options);
  if (!hindered.empty()) return {{}, hindered};
  const std::vector<AnnotationAddress> annotations = usedAnnotations(views);
  const std::optional<Fit> fit = bestFit(views, annotations, options);
  if (!fit)
    return {
        {},
        "no pose fits the annotations: check for swapped pairs, or add one far from the others"};
  return {describe(views, annotations, *fit, options.robust), ""};
}

std::vector<LeftOut> leaveOneOut(std::span<const AnnotatedView> views,
                                 const AnnotationsSolution& solution) {
  std::vector<AnnotationAddress> annotations;
  std::vector<double> weight;
  for (const SolvedAnnotation& annotation : solution.annotations) {
    annotations.push_back(annotation.address);
    weight.push_back(annotation.weight);
  }
  const Eigen::Vector3d middle_m = annotatedSpread(views).middle_in_station_m;
  std::vector<LeftOut> all;
  for (std::size_t i = 0; i < annotations.size(); ++i) {
    std::vector<double> without = weight;
    without[i] = 0.0;
    Pose pose = solution.rig_from_station;
    NormalEquations equations;
    LeftOut left_out;
    left_out.address = annotations[i];
    left_out.determined = refineAnnotations(views, annotations, without, pose, equations);
    if (left_out.determined) {
      left_out.translation_mm =
          1000.0 * (pose * middle_m - solution.rig_from_station * middle_m).norm();
      left_out.rotation_mrad =
          1000.0 *
          rotationLog((pose.rotation * solution.rig_from_station.rotation.conjugate()).normalized())
              .norm();
    }
    all.push_back(left_out);
  }
  return all;
}

Matrix6d cameraCovariance(const AnnotationsSolution& solution, const AnnotatedView& view) {
  return covarianceIn(view.camera_from_rig, solution.covariance);
}

}  // namespace boresight::sessions
