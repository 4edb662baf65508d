// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/alternatives.h"

#include <algorithm>
#include <numeric>

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
  alternative.has_pose = !from.mirrored;
  alternative.mirrored = from.mirrored;
  alternative.camera_from_station = from.camera_from_station;
  alternative.similarity = from.similarity;
  alternative.margin_nats = from.margin_nats;
  return alternative;
}

Alternative ofCompared(const PoseHypothesis& from) {
  Alternative alternative;
  alternative.kind = AlternativeKind::kCompared;
  alternative.number = from.number + 1;
  alternative.has_pose = true;
  alternative.camera_from_station = from.camera_from_station;
  alternative.score = from.score;
  alternative.probability = from.probability;
  alternative.origin = from.origin;
  return alternative;
}

/// The competitor first, then by descending score.
std::vector<std::size_t> byScore(const LocalizationTrace& run) {
  std::vector<std::size_t> order(run.hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t first, std::size_t second) {
    const auto competes = [&](std::size_t i) { return static_cast<int>(i) == run.competitor; };
    if (competes(first) != competes(second)) return competes(first);
    return run.hypotheses[first].score > run.hypotheses[second].score;
  });
  return order;
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
  const bool compares = run.best_hypothesis >= 0;
  const Pose chosen =
      compares ? run.hypotheses[static_cast<std::size_t>(run.best_hypothesis)].camera_from_station
               : best;
  for (const std::size_t i : byScore(run)) {
    all.push_back(ofCompared(run.hypotheses[i]));
    all.back().chosen = static_cast<int>(i) == run.best_hypothesis;
    compare(chosen, all.back());
  }
  for (std::size_t i = 0; i < run.iterations.size(); ++i) addHypotheses(run, i, all);
  return all;
}

}  // namespace boresight::sessions
