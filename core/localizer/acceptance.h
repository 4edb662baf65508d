// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/localizer/workspace.h"
#include "core/search/competing_poses.h"

// The rules by which a pose that has converged is accepted.
namespace boresight {

/// Least evidence margin of the final pose over a competing pose within the seed's uncertainty.
inline constexpr double kLeastMargin_nats = 3.0;
/// Poses of less probability are compared with the mesh's mirror image, and with poses within twice
/// the seed's uncertainty.
inline constexpr double kUndoubted = 0.9;
/// The mesh counts as mirrored when its mirror image has more total evidence than this multiple of
/// the pose's. Symmetric meshes have about the same.
inline constexpr double kMirrorExcess = 1.5;
/// The seed counts as farther off than stated when another pose within twice its uncertainty has
/// more total evidence than this multiple of the pose's.
inline constexpr double kOtherExcess = 1.2;
/// Least margin over a competing pose outside the seed's uncertainty: ln of 10^4, the odds that the
/// seed is wrong or the mesh mirrored.
inline constexpr double kLeastMarginOutside_nats = -9.2;
/// The same for a pose of less probability than kDoubtful.
inline constexpr double kLeastDoubtfulMarginOutside_nats = -2.0;
/// Poses of less probability keep the narrower margin over poses outside the seed's uncertainty.
inline constexpr double kDoubtful = 0.5;

/// Least difference between the scores of the final pose and of the best other pose of the run:
/// with the same edge support, a ratio of 1.1 between their total evidence.
inline constexpr double kLeastGap = 0.1;

/// Whether the image supports the pose after its support pass: kConverged, or the reason why not. A
/// run that searches also judges the probability, edge width and focal length. Edge width and focal
/// length are valid only at a nearly correct pose.
LocalizationStatus judgeSupport(const Workspace& measured, const LocalizerOptions& options,
                                bool searches);

/// kConverged, or kAmbiguous when another hypothesis of the run has about the same score.
LocalizationStatus judgeGap(const Workspace& measured, const LocalizerOptions& options);

/// Least margin of the final pose, of this probability, over a competing pose that is not mirrored.
double leastMargin_nats(const Pose& competing_from_station, double probability, const Seed& seed,
                        const LocalizerOptions& options);

/// kConverged, or kAmbiguous when a competing pose has about as much evidence as the final pose of
/// this probability, or the mesh's mirror image has more.
LocalizationStatus judgeCompetingPoses(std::span<const CompetingPose> poses, double probability,
                                       const Seed& seed, const LocalizerOptions& options);

/// The next comparison of a pose that has passed `last`; none after the last one. Every pose is
/// compared with others that show about the same edges; one below kUndoubted also with the mesh's
/// mirror image, and then with poses within twice the seed's uncertainty. A pose outside the stated
/// uncertainty is also compared with poses within twice the uncertainty.
std::optional<PassKind> comparisonAfter(PassKind last, double probability, const Seed& seed,
                                        const Pose& camera_from_station);

}  // namespace boresight
