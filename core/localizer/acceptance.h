// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/localizer/workspace.h"
#include "core/search/competing_poses.h"

// The rules by which a pose that has converged is accepted.
namespace boresight {

/// Evidence by which the final pose must exceed a competing one within the seed's uncertainty.
inline constexpr double kLeastMargin_nats = 3.0;
/// The same of a competing pose outside, which the seed excludes: with a right mesh none is better,
/// with a mirrored one the half turn is, by 12 to 45 nats.
inline constexpr double kLeastMarginOutside_nats = -2.0;

/// Whether the image supports the pose whose support pass has just ended: kConverged, or why not.
/// A run that searches has measured more: the probability, whether the pose is within the seed's
/// uncertainty (a candidate's own box may reach beyond it), edge width and focal length; those two
/// are of the image only where the pose is about right.
LocalizationStatus judgeSupport(const Workspace& measured, const Seed& seed,
                                const Pose& camera_from_station, const LocalizerOptions& options,
                                bool searches);

/// kConverged, or kAmbiguous when a competing pose has about as much evidence.
LocalizationStatus judgeCompetingPoses(std::span<const CompetingPose> poses, const Seed& seed,
                                       const LocalizerOptions& options);

}  // namespace boresight
