// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/alternatives.h"

#include <algorithm>
#include <limits>

namespace boresight::sessions {
namespace {

void compare(const Pose& chosen, Alternative& alternative) {
  alternative.camera_from_station_chosen = chosen;
  if (!alternative.has_pose) return;
  alternative.apart_m =
      (alternative.camera_from_station.translation_m - chosen.translation_m).norm();
  alternative.apart_rad = alternative.camera_from_station.rotation.angularDistance(chosen.rotation);
}

Alternative ofHypothesis(const IterationTrace& iteration, std::size_t index) {
  const HypothesisSummary& from = iteration.hypotheses[index];
  Alternative alternative;
  alternative.number = static_cast<std::int32_t>(index) + 1;
  alternative.chosen = static_cast<std::int32_t>(index) == iteration.chosen_hypothesis;
  // A render that was only rolled has no pose of its own.
  alternative.has_pose = from.solved;
  alternative.camera_from_station = from.camera_from_station;
  alternative.roll_rad = from.roll_rad;
  alternative.matches = from.matches;
  alternative.inliers = from.inliers;
  return alternative;
}

Alternative ofCompeting(const CompetingPose& from, std::size_t index) {
  Alternative alternative;
  alternative.kind = AlternativeKind::kCompeting;
  alternative.number = static_cast<std::int32_t>(index) + 1;
  alternative.has_pose = true;
  alternative.camera_from_station = from.camera_from_station;
  alternative.similarity = from.similarity;
  alternative.margin_nats = from.margin_nats;
  return alternative;
}

/// The pose of a candidate as the search refined it.
Alternative ofCandidate(const PoseCandidate& from, std::size_t index) {
  Alternative alternative;
  alternative.kind = AlternativeKind::kCandidate;
  alternative.number = static_cast<std::int32_t>(index) + 1;
  alternative.has_pose = true;
  alternative.camera_from_station = from.camera_from_station;
  alternative.roll_rad = from.found.roll_rad;
  alternative.evidence_nats = from.rank_nats();
  return alternative;
}

/// The first iteration of an iteration's attempt. An attempt that repeats an earlier iteration
/// counts as the attempt of that one.
const IterationTrace& startOf(const LocalizationTrace& run, std::size_t index) {
  const auto at = [&run](std::size_t i) -> const IterationTrace& { return *run.iterations[i]; };
  std::size_t first = index;
  while (first > 0 && at(first - 1).attempt == at(index).attempt) --first;
  for (std::size_t i = 0; i < first; ++i)
    if (at(i).camera_from_station_before == at(first).camera_from_station_before)
      return startOf(run, i);
  return at(first);
}

/// The candidate from which the run came to its pose, the nearest to where that attempt began; of a
/// run without a pose the first. -1: the pose comes from the seed.
int chosenCandidate(const LocalizationTrace& run) {
  if (run.candidates.empty()) return -1;
  if (!run.converged() || run.iterations.empty()) return 0;
  const Pose start = startOf(run, run.iterations.size() - 1).camera_from_station_before;
  if (start == run.camera_from_station_seed) return -1;
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < run.candidates.size(); ++i) {
    Vector6d xi = perturbationBetween(run.candidates[i].camera_from_station, start);
    xi.head<3>() *= start.translation_m.norm();  // a turn, seen at its distance
    const double apart = xi.squaredNorm();
    if (apart < least) nearest = static_cast<int>(i);
    least = std::min(least, apart);
  }
  return nearest;
}

void addHypotheses(const LocalizationTrace& run, std::size_t index, std::vector<Alternative>& all) {
  const IterationTrace& iteration = *run.iterations[index];
  if (iteration.hypotheses.size() < 2) return;
  const auto chosen = static_cast<std::size_t>(iteration.chosen_hypothesis);
  for (std::size_t i = 0; i < iteration.hypotheses.size(); ++i) {
    Alternative alternative = ofHypothesis(iteration, i);
    alternative.iteration = static_cast<std::int32_t>(index);
    const bool known = chosen < iteration.hypotheses.size();
    compare(
        known ? iteration.hypotheses[chosen].camera_from_station : iteration.camera_from_station,
        alternative);
    all.push_back(alternative);
  }
}

}  // namespace

std::vector<Alternative> alternativesOf(const LocalizationTrace& run) {
  std::vector<Alternative> all;
  const Pose best = run.lastPose();
  for (std::size_t i = 0; i < run.competing_poses.size(); ++i) {
    all.push_back(ofCompeting(run.competing_poses[i], i));
    compare(best, all.back());
  }
  const int chosen = chosenCandidate(run);
  const auto compared = static_cast<std::size_t>(std::max(chosen, 0));
  for (std::size_t i = 0; i < run.candidates.size(); ++i) {
    all.push_back(ofCandidate(run.candidates[i], i));
    all.back().chosen = static_cast<int>(i) == chosen;
    compare(run.candidates[compared].camera_from_station, all.back());
  }
  for (std::size_t i = 0; i < run.iterations.size(); ++i) addHypotheses(run, i, all);
  return all;
}

}  // namespace boresight::sessions
