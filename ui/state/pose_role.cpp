// SPDX-License-Identifier: Apache-2.0
#include "ui/state/pose_role.h"

namespace boresight::ui {

std::optional<Pose> poseOf(const ViewState& state, PoseRole role) {
  if (!state.currentCase()) return std::nullopt;
  switch (role) {
    case PoseRole::kSeed:
      return state.snapshot() ? state.snapshot()->camera_from_station_seed
                              : state.currentCase()->source.camera_from_station_seed;
    case PoseRole::kEstimate: {
      const sessions::IterationTrace* shown = state.iteration();
      if (shown == nullptr) return std::nullopt;
      return state.cursor().stage >= Stage::kPose ? shown->camera_from_station
                                                  : shown->camera_from_station_before;
    }
    case PoseRole::kNudged:
      return state.nudgedPose();
    case PoseRole::kTruth:
      return state.currentCase()->source.camera_from_station_truth;
    case PoseRole::kAnnotated:
      return state.annotatedPose();
  }
  return std::nullopt;
}

}  // namespace boresight::ui
