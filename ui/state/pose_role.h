// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "ui/state/view_state.h"

namespace boresight::ui {

/// Whose pose something is.
enum class PoseRole : std::uint8_t { kSeed, kEstimate, kNudged, kTruth, kAnnotated };
inline constexpr int kPoseRoles = 5;

/// camera_from_station of that role as the views have it: the run's seed (the case's before a run),
/// the iteration under the cursor (before or after it, as the shown stage says), the nudged pose,
/// the truth, the pose that solves the annotated marks. Nothing where there is none.
std::optional<Pose> poseOf(const ViewState& state, PoseRole role);

}  // namespace boresight::ui
