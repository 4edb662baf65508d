// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_options.h"
#include "core/pnp/pnp_ransac.h"
#include "core/pnp/refine_pose.h"
#include "tests/support/random_pose.h"

/// Synthetic correspondences of a station in front of an arm camera, and a PnpRansac with the
/// memory it needs.
namespace boresight::test {

struct PnpSceneOptions {
  int points = 100;
  double outlier_share = 0.0;
  double noise_px = 0.0;
  double half_width_m = 0.1;
  double half_depth_m = 0.02;  ///< 0: a plane
  double distance_m = 0.45;
  double tilt_rad = 0.1;  ///< sigma of the rotations about x and y
  double sigma_px = 1.0;
};

struct PnpScene {
  Camera camera;
  Pose camera_from_station;  ///< the truth
  PosePrior hypothesis;      ///< inside its uncertainty of the truth
  std::vector<Correspondence> correspondences;
  std::vector<bool> is_outlier;
};

inline Camera armCamera() { return makePinhole(2048, 2048, 3100.0); }

inline PnpScene makeScene(Random& random, const PnpSceneOptions& options,
                          const Camera& camera = armCamera()) {
  PnpScene scene;
  scene.camera = camera;
  scene.camera_from_station.rotation =
      rotationExp({options.tilt_rad * random.normal(), options.tilt_rad * random.normal(),
                   random.uniform(-kPi, kPi)});
  scene.camera_from_station.translation_m = {random.uniform(-0.02, 0.02),
                                             random.uniform(-0.02, 0.02), options.distance_m};
  scene.hypothesis.camera_from_station =
      displacedAboutPivot(scene.camera_from_station, randomOffset(random, scene.hypothesis.sigma),
                          scene.hypothesis.sigma.pivot_in_camera_m);
  for (int i = 0; i < options.points; ++i) {
    Correspondence correspondence;
    correspondence.sigma_px = options.sigma_px;
    correspondence.point_in_station_m = {random.uniform(-1.0, 1.0) * options.half_width_m,
                                         random.uniform(-1.0, 1.0) * options.half_width_m,
                                         random.uniform(-1.0, 1.0) * options.half_depth_m};
    const Eigen::Vector3d point_in_camera_m =
        scene.camera_from_station * correspondence.point_in_station_m;
    const bool outlier = i < static_cast<int>(options.outlier_share * options.points);
    if (!project(camera, point_in_camera_m, correspondence.pixel))
      correspondence.pixel.setConstant(-1e5);
    correspondence.pixel += options.noise_px * Eigen::Vector2d{random.normal(), random.normal()};
    if (outlier) {
      correspondence.pixel = {random.uniform(0.0, camera.width),
                              random.uniform(0.0, camera.height)};
    }
    scene.correspondences.push_back(correspondence);
    scene.is_outlier.push_back(outlier);
  }
  for (std::size_t i = scene.correspondences.size(); i > 1; --i) {
    const std::size_t j = random.below(static_cast<std::uint32_t>(i));
    std::swap(scene.correspondences[i - 1], scene.correspondences[j]);
    std::vector<bool>::swap(scene.is_outlier[i - 1], scene.is_outlier[j]);
  }
  return scene;
}

/// Moves all points to a line through the station's origin, and their pixels with them.
inline void makeCollinear(Random& random, const Eigen::Vector3d& direction, PnpScene& scene) {
  for (Correspondence& item : scene.correspondences) {
    item.point_in_station_m = random.uniform(-0.1, 0.1) * direction;
    EXPECT_TRUE(
        project(scene.camera, scene.camera_from_station * item.point_in_station_m, item.pixel));
  }
}

/// A PnpRansac, its arena, and a solution with room for `capacity` correspondences. The solution
/// starts with invalid values, so that values left by a status are detected.
struct Solver {
  explicit Solver(std::size_t capacity)
      : memory(capacity * 64 + 1024), inlier(capacity, 7), residual_px(capacity, -1.0) {
    Arena arena(memory);
    EXPECT_EQ(ransac.create(static_cast<int>(capacity), arena), Status::kOk);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    solution.camera_from_station.translation_m.setConstant(nan);
    solution.covariance.setConstant(nan);
    solution.inlier_count = -1;
    solution.rms_px = nan;
  }

  Status begin(const PnpScene& scene, double threshold_px, const PnpOptions& options) {
    const std::size_t count = scene.correspondences.size();
    solution.inlier = std::span(inlier).first(count);
    solution.residual_px = std::span(residual_px).first(count);
    return ransac.begin(scene.correspondences, scene.camera, scene.hypothesis, threshold_px,
                        options, solution);
  }

  Status solve(const PnpScene& scene, double threshold_px, const PnpOptions& options) {
    Status status = begin(scene, threshold_px, options);
    bool done = status != Status::kOk;
    while (!done) status = ransac.step(done);
    return status;
  }

  PnpRansac ransac;
  PnpSolution solution;
  std::vector<std::byte> memory;
  std::vector<std::uint8_t> inlier;
  std::vector<double> residual_px;
};

/// A solver that has solved a scene.
struct Solved : Solver {
  Solved(const PnpScene& scene, double threshold_px, const PnpOptions& options = {})
      : Solver(scene.correspondences.size()) {
    EXPECT_EQ(solve(scene, threshold_px, options), Status::kOk);
  }
};

inline PnpView onlyView(const Camera& camera, std::span<const Correspondence> correspondences) {
  return {&camera, Pose(), static_cast<std::int32_t>(correspondences.size())};
}

/// The functions of the core for a single view.
inline Status refinePose(std::span<const Correspondence> correspondences,
                         std::span<const std::uint8_t> use, const Camera& camera,
                         const PosePrior* prior, int max_iterations, Pose& camera_from_station) {
  const PnpView view = onlyView(camera, correspondences);
  return boresight::refinePose(correspondences, use, std::span(&view, 1), prior, max_iterations,
                               camera_from_station);
}
inline Status poseCovariance(std::span<const Correspondence> correspondences,
                             std::span<const std::uint8_t> use, const Camera& camera,
                             const Pose& camera_from_station, Matrix6d& covariance) {
  const PnpView view = onlyView(camera, correspondences);
  return boresight::poseCovariance(correspondences, use, std::span(&view, 1), camera_from_station,
                                   covariance);
}

/// The same of all correspondences of a scene, which must succeed.
inline Pose refinedPose(const PnpScene& scene, Pose start, int max_iterations = 20,
                        const PosePrior* prior = nullptr) {
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, prior, max_iterations, start),
            Status::kOk);
  return start;
}
inline Matrix6d covarianceAt(const PnpScene& scene, const Pose& camera_from_station) {
  Matrix6d covariance;
  EXPECT_EQ(
      poseCovariance(scene.correspondences, {}, scene.camera, camera_from_station, covariance),
      Status::kOk);
  return covariance;
}

/// One sum of the least squares of a pose, written straight from its definition.
inline double reprojectionCost(const std::vector<Correspondence>& correspondences,
                               const std::vector<std::uint8_t>& use, const Camera& camera,
                               const Pose& camera_from_station) {
  double cost = 0.0;
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    if (!use.empty() && use[i] == 0) continue;
    Eigen::Vector2d pixel;
    if (!project(camera, camera_from_station * correspondences[i].point_in_station_m, pixel)) {
      return std::numeric_limits<double>::infinity();
    }
    cost += ((correspondences[i].pixel - pixel) / correspondences[i].sigma_px).squaredNorm();
  }
  return cost;
}

inline double reprojectionCost(const PnpScene& scene, const Pose& camera_from_station) {
  return reprojectionCost(scene.correspondences, {}, scene.camera, camera_from_station);
}
/// The other sum, likewise: squared offsets from the prior in units of its sigmas.
inline double priorCost(const PosePrior& prior, const Pose& camera_from_station) {
  const Vector6d offset = offsetAboutPivot(prior.camera_from_station, camera_from_station,
                                           prior.sigma.pivot_in_camera_m);
  return offset.head<3>().cwiseQuotient(prior.sigma.rotation_rad).squaredNorm() +
         offset.tail<3>().cwiseQuotient(prior.sigma.translation_m).squaredNorm();
}

/// Distance of the least squares from a minimum: the largest component of gradient / curvature by
/// central differences, in the left perturbation (rad, m).
template <class Cost>
double newtonStepLeft(const Cost& cost, const Pose& camera_from_station) {
  const double h = 1e-5;
  double largest = 0.0;
  const double cost_at_pose = cost(camera_from_station);
  for (int k = 0; k < 6; ++k) {
    const Vector6d xi = h * Vector6d::Unit(k);
    const double above = cost(perturbed(xi, camera_from_station));
    const double below = cost(perturbed(-xi, camera_from_station));
    const double gradient = (above - below) / (2.0 * h);
    const double curvature = (above - 2.0 * cost_at_pose + below) / (h * h);
    largest = std::max(largest, std::abs(gradient / curvature));
  }
  return largest;
}

}  // namespace boresight::test
