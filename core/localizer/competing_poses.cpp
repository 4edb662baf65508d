// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/competing_poses.h"

#include <algorithm>

#include "core/localizer/pose_change.h"

namespace boresight {

bool CompetingPoses::isInSeedsBox(const Pose& camera_from_station,
                                  const LocalizerOptions& options) const {
  return !leftUncertainty(seed_, camera_from_station, options.loop.leave_factor);
}

CompetingPoses::Next CompetingPoses::takePose(const Attempt& attempt,
                                              const Pose& camera_from_station_before,
                                              double best_margin_nats, const RunContext& run,
                                              bool& leads) {
  leads = true;
  if (round_ == Round::kNone) {
    lead(attempt, camera_from_station_before);
    return Next::kCompare;
  }
  Rival& pose = poses_[static_cast<std::size_t>(trial_)];
  pose.ended = LocalizationStatus::kConverged;
  pose.camera_from_station = attempt.camera_from_station();
  pose.margin_nats = best_margin_nats;
  if (best_margin_nats >= 0.0 || (!isInSeedsBox(pose.camera_from_station, run.options) &&
                                  -best_margin_nats < kMinMargin_nats)) {
    leads = false;
    return next();
  }
  // The former best pose takes its place, and its margins over the others grow accordingly.
  for (Rival& other : poses_.first(static_cast<std::size_t>(trial_))) {
    if (other.ended == LocalizationStatus::kConverged) other.margin_nats -= best_margin_nats;
  }
  pose.camera_from_station = best_.camera_from_station();
  pose.margin_nats = -best_margin_nats;
  best_index_ = trial_;
  lead(attempt, camera_from_station_before);
  return Next::kCompare;
}

void CompetingPoses::lead(const Attempt& attempt, const Pose& camera_from_station_before) {
  round_ = Round::kComparison;
  best_ = attempt;
  best_before_ = camera_from_station_before;
  best_is_shown_ = true;
}

CompetingPoses::Next CompetingPoses::takeFailure(LocalizationStatus status) {
  poses_[static_cast<std::size_t>(trial_)].ended = status;
  return next();
}

PassPlan CompetingPoses::comparison() const {
  PassPlan plan;
  plan.kind = PassKind::kSelfSimilarity;
  // From one end of the seed's uncertainty to the other.
  const Eigen::Vector3d reach_m = 2.0 * kReach * seed_.uncertainty.translation_m;
  plan.reach_x_m = reach_m.x();
  plan.reach_y_m = reach_m.y();
  return plan;
}

CompetingPoses::Next CompetingPoses::takeShifts(std::span<const SelfShift> shifts,
                                                const RunContext& run) {
  for (const SelfShift& shift : shifts) {
    if (count_ == static_cast<int>(poses_.size())) break;
    const Pose& best = best_.camera_from_station();
    Pose moved = best;
    moved.translation_m += shift.displacement_in_camera_m;
    const double shift_px = displacementBetween_px(best, moved, run.scene, run.camera);
    if (leftUncertainty(seed_, moved, kReach) || isKnown(moved, 0.4 * shift_px, run)) continue;
    Rival& pose = poses_[static_cast<std::size_t>(count_++)];
    pose = Rival();
    pose.camera_from_station_before = moved;
    pose.camera_from_station = moved;
    pose.similarity = shift.similarity;
  }
  round_ = Round::kTrials;
  trial_ = best_index_;
  return next();
}

bool CompetingPoses::isKnown(const Pose& camera_from_station, double within_px,
                             const RunContext& run) const {
  const auto isNear = [&](const Pose& other) {
    return displacementBetween_px(other, camera_from_station, run.scene, run.camera) < within_px;
  };
  const auto known = poses();
  return isNear(best_.camera_from_station()) ||
         std::any_of(known.begin(), known.end(), [&](const Rival& pose) {
           return isNear(pose.camera_from_station_before) || isNear(pose.camera_from_station);
         });
}

CompetingPoses::Next CompetingPoses::next() {
  ++trial_;
  if (trial_ < count_) {
    best_is_shown_ = false;
    return Next::kTry;
  }
  round_ = Round::kEnd;
  return best_is_shown_ ? Next::kConclude : Next::kReturn;
}

Attempt CompetingPoses::competitor(int index, const RunContext& run) const {
  constexpr double kBox = 0.25;         // of the distance to the best pose
  constexpr double kTurn_rad = 0.0262;  // 1.5 deg: the edges have the directions of the best pose
  const Pose& pose = poses_[static_cast<std::size_t>(trial_)].camera_from_station_before;
  const double distance_m = (pose.translation_m - best_.camera_from_station().translation_m).norm();
  Seed seed;
  seed.camera_from_station = pose;
  seed.uncertainty.translation_m.setConstant(kBox * distance_m);
  seed.uncertainty.rotation_rad.setConstant(kTurn_rad);
  seed.uncertainty.pivot_in_camera_m = pose * run.scene.centre();
  return best_.competing(index, seed, run.options);
}

Attempt CompetingPoses::best(int index, const LocalizerOptions& options) const {
  return best_.beforeLastIteration(index, best_before_, options);
}

LocalizationStatus CompetingPoses::verdict(const Pose& camera_from_station,
                                           const LocalizerOptions& options) const {
  if (!isInSeedsBox(camera_from_station, options)) return LocalizationStatus::kLeftUncertainty;
  const auto known = poses();
  const bool ambiguous = std::any_of(known.begin(), known.end(), [&](const Rival& pose) {
    return pose.ended == LocalizationStatus::kConverged && pose.margin_nats < kMinMargin_nats &&
           isInSeedsBox(pose.camera_from_station, options);
  });
  return ambiguous ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged;
}

std::span<const Rival> CompetingPoses::takeTwins(std::span<const Twin> twins) {
  count_ = 0;
  for (const Twin& twin : twins) {
    if (count_ == static_cast<int>(poses_.size())) break;
    Rival& pose = poses_[static_cast<std::size_t>(count_++)];
    pose = Rival();
    pose.camera_from_station_before = twin.camera_from_station;
    pose.camera_from_station = twin.camera_from_station;
    pose.similarity = twin.similarity;
    pose.ended = LocalizationStatus::kConverged;
    pose.margin_nats = twin.margin_nats;
  }
  return poses();
}

LocalizationStatus CompetingPoses::verdictOnTwins(const LocalizerOptions& options) const {
  const auto twins = poses();
  const bool ambiguous = std::any_of(twins.begin(), twins.end(), [&](const Rival& twin) {
    return twin.margin_nats < (isInSeedsBox(twin.camera_from_station, options)
                                   ? kTwinMargin_nats
                                   : kOutsideMargin_nats);
  });
  return ambiguous ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged;
}

}  // namespace boresight
