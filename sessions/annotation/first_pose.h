// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "sessions/annotation/marked_view.h"

namespace boresight::sessions {

/// Where least squares over marks may begin: the pose that agrees with most points of the view that
/// has the most of them (P3P, RANSAC). Nothing where no view has four, or none agree.
std::optional<Pose> firstPose(std::span<const MarkedView> views);

/// The other pose that a plane of marks may have: its normal mirrored about the line of sight
/// (Schweighofer and Pinz, "Robust Pose Estimation from a Planar Target", PAMI 2006). Nothing where
/// the marks do not lie in a plane.
std::optional<Pose> mirroredPose(std::span<const MarkedView> views, const Pose& rig_from_station);

}  // namespace boresight::sessions
