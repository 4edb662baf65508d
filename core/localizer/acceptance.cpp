// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/acceptance.h"

#include <algorithm>

#include "core/localizer/pose_change.h"

namespace boresight {

LocalizationStatus judgeSupport(const Workspace& measured, const LocalizerOptions& options,
                                bool searches) {
  const SupportOptions& support = options.support;
  if (!(searches ? isProbable(measured.probability, support)
                 : isSupported(measured.support, support)))
    return LocalizationStatus::kNotSupported;
  if (support.gate && !measured.edge_width.isSharp()) return LocalizationStatus::kBlurred;
  if (support.gate && measured.focal.disagrees()) return LocalizationStatus::kCameraMismatch;
  return LocalizationStatus::kConverged;
}

LocalizationStatus judgeGap(const Workspace& measured, const LocalizerOptions& options) {
  const bool ambiguous =
      options.support.gate && measured.competitor >= 0 && measured.gap <= kLeastGap;
  return ambiguous ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged;
}

double leastMargin_nats(const Pose& competing_from_station, double probability, const Seed& seed,
                        const LocalizerOptions& options) {
  if (!leftUncertainty(seed, competing_from_station, options.loop.leave_factor))
    return kLeastMargin_nats;
  return probability < kDoubtful ? kLeastDoubtfulMarginOutside_nats : kLeastMarginOutside_nats;
}

LocalizationStatus judgeCompetingPoses(std::span<const CompetingPose> poses, double probability,
                                       const Seed& seed, const LocalizerOptions& options) {
  const bool ambiguous = std::any_of(poses.begin(), poses.end(), [&](const CompetingPose& pose) {
    return pose.mirrored || pose.margin_nats < leastMargin_nats(pose.camera_from_station,
                                                                probability, seed, options);
  });
  return ambiguous ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged;
}

std::optional<PassKind> comparisonAfter(PassKind last, double probability, const Seed& seed,
                                        const Pose& camera_from_station) {
  if (last == PassKind::kWider) return std::nullopt;
  const bool is_probable = probability >= kUndoubted;
  if (!is_probable && last == PassKind::kCompare) return PassKind::kMirror;
  if (!is_probable || leftUncertainty(seed, camera_from_station, 1.0)) return PassKind::kWider;
  return std::nullopt;
}

}  // namespace boresight
