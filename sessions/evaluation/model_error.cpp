// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/model_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "core/base/math.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

constexpr int kTurnSteps = 315;  ///< bop_toolkit: ceil(pi / 0.01)
constexpr int kRefinements = 48;

/// From one point, in the form that Eigen's tree requires.
struct SquaredDistance {
  using Scalar = double;
  const Eigen::Vector3d& from;

  double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
    return box.squaredExteriorDistance(from);
  }
  double minimumOnObject(const Eigen::Vector3d& point) const {
    return (point - from).squaredNorm();
  }
};

/// What a pose that looks like the truth costs; may stop, with anything not below it, at `bound`.
using Cost = std::function<double(const Pose& camera_from_station, double bound)>;

struct Least {
  double cost = std::numeric_limits<double>::infinity();
  Pose camera_from_station;

  void take(const Cost& cost_of, const Pose& pose) {
    const double value = cost_of(pose, cost);
    if (!(value < cost)) return;
    cost = value;
    camera_from_station = pose;
  }
};

/// Golden-section search of the angle within one step of the best sample.
void refine(const Cost& cost_of, const std::function<Pose(double)>& at, double middle_rad,
            double step_rad, Least& least) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  double low = middle_rad - step_rad;
  double high = middle_rad + step_rad;
  for (int i = 0; i < kRefinements; ++i) {
    const double width = ratio * (high - low);
    if (cost_of(at(high - width), kUnbounded) <= cost_of(at(low + width), kUnbounded))
      high = low + width;
    else
      low = high - width;
  }
  least.take(cost_of, at(0.5 * (low + high)));
}

void searchTurns(const Cost& cost_of, const Pose& camera_from_station, const AxisSymmetry& symmetry,
                 Least& least) {
  const double step_rad = 2.0 * kPi / kTurnSteps;
  const auto at = [&](double angle_rad) {
    return camera_from_station * turnAbout(symmetry, angle_rad);
  };
  Least sampled;
  int best = 0;
  for (int i = 0; i < kTurnSteps; ++i) {
    const double before = sampled.cost;
    sampled.take(cost_of, at(i * step_rad));
    if (sampled.cost < before) best = i;
  }
  if (sampled.cost < least.cost) least = sampled;
  refine(cost_of, at, best * step_rad, step_rad, least);
}

bool hasSymmetries(const Symmetries* symmetries) {
  return symmetries != nullptr && !symmetries->empty();
}

/// The least cost over everything that looks like the truth. BOP turns about an axis after each
/// discrete symmetry: p -> turn * (discrete * p).
Least leastOver(const Cost& cost_of, const Pose& truth, const Symmetries* symmetries) {
  Least least;
  least.take(cost_of, truth);
  if (!hasSymmetries(symmetries)) return least;
  std::vector<Pose> discrete = symmetries->discrete;
  discrete.insert(discrete.begin(), Pose());
  for (const Pose& pose : discrete) {
    least.take(cost_of, truth * pose);
    for (const AxisSymmetry& symmetry : symmetries->continuous) {
      const Cost turned = [&](const Pose& camera_from_turned, double bound) {
        return cost_of(camera_from_turned * pose, bound);
      };
      Least found;
      searchTurns(turned, truth, symmetry, found);
      if (found.cost < least.cost) least = {found.cost, found.camera_from_station * pose};
    }
  }
  return least;
}

/// Points of a model under a pose.
std::vector<Eigen::Vector3d> placed(const Pose& camera_from_station, const ModelView& model) {
  const Eigen::Matrix3d rotation = camera_from_station.matrix();
  std::vector<Eigen::Vector3d> points;
  points.reserve(model.vertices_in_station_m.size());
  for (const Eigen::Vector3f& vertex : model.vertices_in_station_m)
    points.push_back(rotation * vertex.cast<double>() + camera_from_station.translation_m);
  return points;
}

/// d(i) is the distance of vertex i, a point of the camera frame under the candidate truth.
template <class Distance>
Cost largest(const ModelView& model, Distance distance) {
  return [model, distance](const Pose& truth, double bound) {
    const Eigen::Matrix3d rotation = truth.matrix();
    double value = 0.0;
    for (std::size_t i = 0; i < model.vertices_in_station_m.size() && value < bound; ++i) {
      const Eigen::Vector3d point =
          rotation * model.vertices_in_station_m[i].cast<double>() + truth.translation_m;
      value = std::max(value, distance(i, point));
    }
    return value;
  };
}

Least leastSurfaceDistance(const Pose& truth, const Pose& estimate, const ModelView& model) {
  const std::vector<Eigen::Vector3d> points = placed(estimate, model);
  const auto distance = [&points](std::size_t i, const Eigen::Vector3d& point) {
    return (points[i] - point).norm();
  };
  return leastOver(largest(model, distance), truth, model.symmetries);
}

/// A pixel, or nothing where the camera cannot project.
std::optional<Eigen::Vector2d> pixelOf(const Camera& camera, const Eigen::Vector3d& point) {
  Eigen::Vector2d pixel;
  if (!project(camera, point, pixel)) return std::nullopt;
  return pixel;
}

}  // namespace

double surfaceDistance_m(const Pose& camera_from_station_true,
                         const Pose& camera_from_station_estimated, const ModelView& model) {
  return leastSurfaceDistance(camera_from_station_true, camera_from_station_estimated, model).cost;
}

std::optional<double> projectionDistance_px(const Camera& camera,
                                            const Pose& camera_from_station_true,
                                            const Pose& camera_from_station_estimated,
                                            const ModelView& model) {
  const double diagonal_px = std::hypot(camera.width, camera.height);
  std::vector<std::optional<Eigen::Vector2d>> pixels;
  for (const Eigen::Vector3d& point : placed(camera_from_station_estimated, model))
    pixels.push_back(pixelOf(camera, point));
  const auto distance = [&](std::size_t i, const Eigen::Vector3d& point) {
    const auto pixel = pixelOf(camera, point);
    if (!pixel) return 0.0;
    return pixels[i] ? (*pixels[i] - *pixel).norm() : diagonal_px;
  };
  const auto seen = placed(camera_from_station_true, model);
  if (std::none_of(seen.begin(), seen.end(),
                   [&](const Eigen::Vector3d& point) { return pixelOf(camera, point); }))
    return std::nullopt;
  return leastOver(largest(model, distance), camera_from_station_true, model.symmetries).cost;
}

double meanDistance_m(const Pose& camera_from_station_true,
                      const Pose& camera_from_station_estimated, const ModelView& model) {
  const std::vector<Eigen::Vector3d> points = placed(camera_from_station_estimated, model);
  const Cost mean = [&](const Pose& truth, double) {
    const std::vector<Eigen::Vector3d> others = placed(truth, model);
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) sum += (points[i] - others[i]).norm();
    return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
  };
  return leastOver(mean, camera_from_station_true, model.symmetries).cost;
}

double meanNearestDistance_m(const Pose& camera_from_station_true,
                             const Pose& camera_from_station_estimated, const ModelView& model) {
  const NearestPoint nearest(placed(camera_from_station_estimated, model));
  const std::vector<Eigen::Vector3d> points = placed(camera_from_station_true, model);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) sum += nearest.distance(point);
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

Pose nearestEquivalent(const Pose& camera_from_station, const Pose& other_camera_from_station,
                       const ModelView& model) {
  if (!hasSymmetries(model.symmetries) || camera_from_station == other_camera_from_station)
    return camera_from_station;
  return leastSurfaceDistance(camera_from_station, other_camera_from_station, model)
      .camera_from_station;
}

PoseMotions symmetricMotions(const Pose& camera_from_station, const Symmetries& symmetries) {
  PoseMotions motions(6, std::ssize(symmetries.continuous));
  Eigen::Index column = 0;
  for (const AxisSymmetry& symmetry : symmetries.continuous) {
    const Eigen::Vector3d axis = camera_from_station.rotation * symmetry.axis;
    motions.col(column++) << axis, (camera_from_station * symmetry.point_m).cross(axis);
  }
  return motions;
}

Matrix6d projectionWithout(const PoseMotions& motions, const Matrix6d& metric) {
  if (motions.cols() == 0) return Matrix6d::Identity();
  const Eigen::MatrixXd of_motions = motions.transpose() * metric * motions;
  // An axis may be declared twice.
  const Eigen::MatrixXd inverse = of_motions.completeOrthogonalDecomposition().pseudoInverse();
  return Matrix6d::Identity() - motions * inverse * motions.transpose() * metric;
}

Matrix6d determinedCovariance(const Matrix6d& covariance, const Pose& camera_from_station,
                              const ModelView& model) {
  if (model.symmetries == nullptr || model.symmetries->continuous.empty()) return covariance;
  Matrix6d metric = Matrix6d::Zero();
  for (const Eigen::Vector3d& point : placed(camera_from_station, model)) {
    const Eigen::Matrix<double, 3, 6> moves = displacementOf(point);
    metric += moves.transpose() * moves;
  }
  const Matrix6d determined =
      projectionWithout(symmetricMotions(camera_from_station, *model.symmetries), metric);
  return determined * covariance * determined.transpose();
}

PoseError errorToTruth(const Camera& camera, const Pose& camera_from_station_true,
                       const Pose& camera_from_station_estimated,
                       const std::optional<Pose>& camera_from_end_effector,
                       const ModelView& model) {
  const Pose truth =
      nearestEquivalent(camera_from_station_true, camera_from_station_estimated, model);
  PoseError error = poseError(truth, camera_from_station_estimated, camera_from_end_effector);
  error.projection_px =
      projectionError(camera, truth, camera_from_station_estimated, model.vertices_in_station_m);
  return error;
}

PoseError wholeError(const Camera& camera, const Pose& camera_from_station_true,
                     const Pose& camera_from_station_estimated,
                     const std::optional<Pose>& camera_from_end_effector, const ModelView& model) {
  const Pose& estimate = camera_from_station_estimated;
  const Least least = leastSurfaceDistance(camera_from_station_true, estimate, model);
  const Pose& truth = least.camera_from_station;
  PoseError error = errorToTruth(camera, truth, estimate, camera_from_end_effector,
                                 {model.vertices_in_station_m});
  error.mssd_mm = kMillimetres * least.cost;
  error.mspd_px = projectionDistance_px(camera, truth, estimate, model);
  error.add_mm = kMillimetres * meanDistance_m(truth, estimate, model);
  error.adi_mm = kMillimetres * meanNearestDistance_m(truth, estimate, model);
  return error;
}

NearestPoint::NearestPoint(const std::vector<Eigen::Vector3d>& points) : empty_(points.empty()) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Eigen::Vector3d& point : points) boxes.emplace_back(point);
  tree_.init(points.begin(), points.end(), boxes.begin(), boxes.end());
}

double NearestPoint::distance(const Eigen::Vector3d& point) const {
  if (empty_) return std::numeric_limits<double>::infinity();
  SquaredDistance to{point};
  return std::sqrt(Eigen::BVMinimize(tree_, to));
}

}  // namespace boresight::sessions
