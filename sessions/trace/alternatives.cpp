// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/alternatives.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace boresight::sessions {
namespace {

void compare(const Pose& chosen, Alternative& alternative) {
  alternative.camera_from_station_chosen = chosen;
  if (!alternative.has_pose) return;
  alternative.apart_m =
      (alternative.camera_from_station.translation_m - chosen.translation_m).norm();
  alternative.apart_rad = alternative.camera_from_station.rotation.angularDistance(chosen.rotation);
}

Alternative ofHypothesis(const HypothesisSummary& from, std::size_t index) {
  return {.number = static_cast<std::int32_t>(index) + 1,
          .has_pose = from.solved,  // a render that was only rolled has no pose of its own
          .camera_from_station = from.camera_from_station,
          .roll_rad = from.roll_rad,
          .matches = from.matches,
          .inliers = from.inliers};
}

Alternative ofCompeting(const CompetingPose& from, std::size_t index) {
  return {.kind = AlternativeKind::kCompeting,
          .number = static_cast<std::int32_t>(index) + 1,
          .has_pose = !from.mirrored,
          .camera_from_station = from.camera_from_station,
          .similarity = from.similarity,
          .margin_nats = from.margin_nats,
          .mirrored = from.mirrored};
}

Alternative ofCompared(const PoseHypothesis& from) {
  return {.kind = AlternativeKind::kCompared,
          .number = from.number + 1,
          .has_pose = true,
          .camera_from_station = from.camera_from_station,
          .score = from.score,
          .probability = from.probability,
          .origin = from.origin};
}

/// The competitor first, then by descending score.
std::vector<std::size_t> byScore(const LocalizationTrace& run) {
  std::vector<std::size_t> order(run.hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&run](std::size_t i) {
    return std::pair(static_cast<int>(i) != run.competitor, -run.hypotheses[i].score);
  });
  return order;
}

void addHypotheses(const LocalizationTrace& run, std::size_t index, std::vector<Alternative>& all) {
  const IterationTrace& iteration = *run.iterations[index];
  const auto& hypotheses = iteration.hypotheses;
  if (hypotheses.size() < 2) return;
  const auto chosen = static_cast<std::size_t>(iteration.chosen_hypothesis);
  const Pose& chosen_pose = chosen < hypotheses.size() ? hypotheses[chosen].camera_from_station
                                                       : iteration.camera_from_station;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    Alternative& alternative = all.emplace_back(ofHypothesis(hypotheses[i], i));
    alternative.iteration = static_cast<std::int32_t>(index);
    alternative.chosen = i == chosen;
    compare(chosen_pose, alternative);
  }
}

}  // namespace

std::vector<Alternative> alternativesOf(const LocalizationTrace& run) {
  std::vector<Alternative> all;
  const Pose best = run.lastPose();
  for (std::size_t i = 0; i < run.competing_poses.size(); ++i)
    compare(best, all.emplace_back(ofCompeting(run.competing_poses[i], i)));
  const Pose chosen =
      run.best_hypothesis < 0
          ? best
          : run.hypotheses[static_cast<std::size_t>(run.best_hypothesis)].camera_from_station;
  for (const std::size_t i : byScore(run)) {
    Alternative& alternative = all.emplace_back(ofCompared(run.hypotheses[i]));
    alternative.chosen = static_cast<int>(i) == run.best_hypothesis;
    compare(chosen, alternative);
  }
  for (std::size_t i = 0; i < run.iterations.size(); ++i) addHypotheses(run, i, all);
  return all;
}

}  // namespace boresight::sessions
