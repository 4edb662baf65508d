// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/refine_marks.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

constexpr int kMostSteps = 200;
constexpr double kStepDone = 1e-11;  ///< rad, and m per m of distance
constexpr double kFirstDamping = 1e-4;
constexpr double kLargestDamping = 1e10;
/// Near the minimum a good step changes the sum by less than its rounding error.
constexpr double kRoundingOfCost = 1e-13;

bool isNegligible(const Vector6d& xi, const Pose& pose) {
  const double distance_m = std::max(pose.translation_m.cwiseAbs().maxCoeff(), 1e-3);
  return xi.head<3>().cwiseAbs().maxCoeff() < kStepDone &&
         xi.tail<3>().cwiseAbs().maxCoeff() < kStepDone * distance_m;
}

}  // namespace

bool refineMarks(std::span<const MarkedView> views, std::span<const MarkAddress> marks,
                 std::span<const double> weight, Pose& rig_from_station,
                 NormalEquations& equations) {
  Pose pose = rig_from_station;
  equations = markEquations(views, marks, weight, pose);
  double damping = 0.0;
  for (int step = 0; step < kMostSteps && damping <= kLargestDamping; ++step) {
    Vector6d xi;
    if (!solve(equations, damping, xi)) {
      damping = std::max(kFirstDamping, damping * 10.0);
      continue;
    }
    Pose next = perturbed(xi, pose);
    next.rotation.normalize();
    const NormalEquations there = markEquations(views, marks, weight, next);
    const bool negligible = isNegligible(xi, pose);
    if (next.isFinite() && there.cost() <= equations.cost() * (1.0 + kRoundingOfCost)) {
      pose = next;
      equations = there;
      damping = damping <= kFirstDamping ? 0.0 : damping / 10.0;
    } else {
      damping = std::max(kFirstDamping, damping * 10.0);
    }
    if (negligible) break;
  }
  Vector6d unused;
  if (equations.missing > 0 || !solve(equations, 0.0, unused)) return false;
  rig_from_station = pose;
  return true;
}

}  // namespace boresight::sessions
