// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/support/example_run.h"

namespace boresight::test {

/// The example's run as if two rivals of its result had been looked for: one that converged 22 mm
/// beside it, in an attempt that the last two iterations stand for, and one that did not; and as if
/// its search had found two candidates.
inline std::shared_ptr<const sessions::LocalizationTrace> runWithRivals() {
  auto run = std::make_shared<sessions::LocalizationTrace>(*exampleRun());
  PoseCandidate chosen;
  chosen.camera_from_station = run->iterations.front()->camera_from_station;
  chosen.evidence.edges_nats = 0.9;
  PoseCandidate turned = chosen;
  turned.evidence.edges_nats = 0.4;
  turned.camera_from_station.rotation =
      rotationExp({0.0, 0.0, 0.3}) * chosen.camera_from_station.rotation;
  run->candidates = {chosen, turned};
  Rival beside;
  beside.camera_from_station_before = run->camera_from_station;
  beside.camera_from_station_before.translation_m.x() += 0.022;
  beside.camera_from_station = beside.camera_from_station_before;
  beside.similarity = 0.45;
  beside.ended = LocalizationStatus::kConverged;
  beside.margin_nats = 395.0;
  Rival other = beside;
  other.camera_from_station_before.translation_m.x() -= 0.044;
  other.ended = LocalizationStatus::kNotSupported;
  run->rivals = {beside, other};
  for (int i = 0; i < 2; ++i) {
    auto copy = std::make_shared<sessions::IterationTrace>(*run->iterations.back());
    copy->attempt = 1;
    copy->camera_from_station_before = beside.camera_from_station_before;
    run->iterations.push_back(copy);
  }
  auto back = std::make_shared<sessions::IterationTrace>(*exampleRun()->iterations.back());
  back->attempt = 2;
  run->iterations.push_back(back);
  return run;
}

}  // namespace boresight::test
