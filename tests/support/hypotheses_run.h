// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/support/example_run.h"

namespace boresight::test {

/// The example's run as if two poses competed with its result, 22 mm to either side, and as if its
/// search had found two candidates, which were compared.
inline std::shared_ptr<const sessions::LocalizationTrace> runWithHypotheses() {
  auto run = std::make_shared<sessions::LocalizationTrace>(*exampleRun());
  PoseCandidate chosen;
  chosen.camera_from_station = run->iterations.front()->camera_from_station;
  chosen.evidence.edges_nats = 0.9;
  PoseCandidate turned = chosen;
  turned.evidence.edges_nats = 0.4;
  turned.camera_from_station.rotation =
      rotationExp({0.0, 0.0, 0.3}) * chosen.camera_from_station.rotation;
  run->candidates = {chosen, turned};
  run->hypotheses.clear();
  for (const PoseCandidate& candidate : run->candidates) {
    PoseHypothesis hypothesis;
    hypothesis.camera_from_station = candidate.camera_from_station;
    hypothesis.number = static_cast<std::int32_t>(run->hypotheses.size());
    hypothesis.score = 10.0 * candidate.rank_nats();
    hypothesis.probability = candidate.rank_nats();
    run->hypotheses.push_back(hypothesis);
  }
  run->best_hypothesis = 0;
  run->competitor = 1;
  run->gap = run->hypotheses[0].score - run->hypotheses[1].score;
  CompetingPose right;
  right.camera_from_station = run->camera_from_station;
  right.camera_from_station.translation_m.x() += 0.022;
  right.similarity = 0.45;
  right.margin_nats = 395.0;
  CompetingPose left = right;
  left.camera_from_station.translation_m.x() -= 0.044;
  run->competing_poses = {right, left};
  return run;
}

}  // namespace boresight::test
