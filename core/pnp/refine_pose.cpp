// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/refine_pose.h"

#include <algorithm>

#include "core/pnp/normal_equations.h"

namespace boresight {
namespace {

constexpr double kStepDone = 1e-11;  ///< rad, and m per m of distance: far below any pixel
constexpr double kFirstDamping = 1e-4;
constexpr double kLargestDamping = 1e8;
constexpr double kDampingFactor = 10.0;
constexpr double kSmallestVariance = 1e-12;
/// Near the minimum a good step changes the sum by less than its rounding error; refusing it there
/// would stop short of the minimum.
constexpr double kRoundingOfCost = 1e-13;
constexpr int kFewestPoints = 3;

struct Problem {
  std::span<const Correspondence> correspondences;
  std::span<const std::uint8_t> use;
  std::span<const PnpView> views;
  const PosePrior* prior;
};

NormalEquations equationsAt(const Problem& problem, const Pose& camera_from_station) {
  NormalEquations equations = reprojectionEquations(problem.correspondences, problem.use,
                                                    problem.views, camera_from_station);
  if (problem.prior != nullptr) addPrior(*problem.prior, camera_from_station, equations);
  return equations;
}

bool hasConverged(const Vector6d& xi, const Pose& camera_from_station) {
  const double distance_m = camera_from_station.translation_m.cwiseAbs().maxCoeff();
  return xi.head<3>().cwiseAbs().maxCoeff() < kStepDone &&
         xi.tail<3>().cwiseAbs().maxCoeff() < kStepDone * std::max(distance_m, 1e-3);
}

Pose stepped(const Vector6d& xi, const Pose& camera_from_station) {
  Pose next = perturbed(xi, camera_from_station);
  next.rotation.normalize();
  return next;
}

double raised(double damping) { return damping == 0.0 ? kFirstDamping : damping * kDampingFactor; }

double lowered(double damping) { return damping <= kFirstDamping ? 0.0 : damping / kDampingFactor; }

/// Steps from `pose` until one is negligible; `equations` are those at `pose`, before and after.
void iterate(const Problem& problem, int max_iterations, Pose& pose, NormalEquations& equations) {
  double damping = 0.0;
  for (int i = 0; i < max_iterations && damping <= kLargestDamping; ++i) {
    Vector6d xi;
    if (!solve(equations, damping, xi)) {
      damping = raised(damping);
      continue;
    }
    const Pose next = stepped(xi, pose);
    const bool done = hasConverged(xi, pose);
    const NormalEquations next_equations = equationsAt(problem, next);
    if (isUsable(next) && next_equations.cost() <= equations.cost() * (1.0 + kRoundingOfCost)) {
      pose = next;
      equations = next_equations;
      damping = lowered(damping);
    } else {
      damping = raised(damping);
    }
    if (done) return;
  }
}

}  // namespace

Status refinePose(std::span<const Correspondence> correspondences,
                  std::span<const std::uint8_t> use, std::span<const PnpView> views,
                  const PosePrior* prior, int max_iterations, Pose& first_from_station) {
  if (!use.empty() && use.size() != correspondences.size()) return Status::kTooFewPoints;
  if (!isUsable(first_from_station)) return Status::kInvalidPose;
  if (prior != nullptr && !isUsable(*prior)) return Status::kInvalidPose;
  const Problem problem{correspondences, use, views, prior};
  Pose pose = first_from_station;
  NormalEquations equations = equationsAt(problem, pose);
  iterate(problem, max_iterations, pose, equations);
  if (prior == nullptr && equations.projected < kFewestPoints) return Status::kDegenerate;
  Vector6d unused;
  if (!solve(equations, 0.0, unused)) return Status::kDegenerate;
  first_from_station = pose;
  return Status::kOk;
}

Status poseCovariance(std::span<const Correspondence> correspondences,
                      std::span<const std::uint8_t> use, std::span<const PnpView> views,
                      const Pose& first_from_station, Matrix6d& covariance) {
  if (!use.empty() && use.size() != correspondences.size()) return Status::kTooFewPoints;
  if (!isUsable(first_from_station)) return Status::kInvalidPose;
  const NormalEquations equations =
      reprojectionEquations(correspondences, use, views, first_from_station);
  Matrix6d inverse;
  if (equations.projected < kFewestPoints || !invert(equations.information, inverse)) {
    return Status::kDegenerate;
  }
  const int freedom = std::max(2 * equations.projected - 6, 1);
  covariance = inverse * std::max(equations.squares / freedom, kSmallestVariance);
  return Status::kOk;
}

}  // namespace boresight
