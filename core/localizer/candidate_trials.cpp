// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/candidate_trials.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"

namespace boresight {
namespace {

// Uncertainty that remains after the search, as shares of the object's size and of its depth, and
// in rotation.
constexpr double kLateral = 0.03;
constexpr double kDepth = 0.04;
constexpr double kRotation_rad = 4.0 * kDegree_rad;

/// A pose of this probability is not compared with others.
constexpr double kSure = 0.98;
/// Candidates are not compared when their evidence is lower by more than this.
constexpr double kAboutAsMuch_nats = 0.2;
/// Share of its search radius over which a refinement converges reliably.
constexpr double kOfRadius = 0.67;

/// Whether a refinement on edges at the level converges from the candidate's pose.
bool isWithinReach(const PoseCandidate& candidate, int level) {
  return candidate.error_px <= kOfRadius * kFirstRadius_px * static_cast<double>(1 << level);
}

}  // namespace

SeedUncertainty uncertaintyAbout(const Pose& camera_from_station, const Seed& seed,
                                 const BoundingBox& scene) {
  const Eigen::Vector3d middle_m = camera_from_station * scene.centre();
  const double lateral_m = kLateral * scene.diagonal();
  SeedUncertainty uncertainty;
  uncertainty.translation_m =
      Eigen::Vector3d(lateral_m, lateral_m, std::max(lateral_m, kDepth * middle_m.z()));
  uncertainty.rotation_rad =
      seed.uncertainty.rotation_rad.cwiseMin(Eigen::Vector3d::Constant(kRotation_rad));
  uncertainty.pivot_in_camera_m = middle_m;
  return uncertainty;
}

/// The last of several starts is the seed.
bool CandidateTrials::triesSeed(const RunContext& run) const {
  return next_ >= static_cast<int>(candidates_.size()) ||
         (next_ > 0 && next_ + 1 >= run.options.loop.max_attempts);
}

bool CandidateTrials::hasNext(const RunContext& run) const {
  return matched_ >= 0 || (!seed_tried_ && next_ < run.options.loop.max_attempts);
}

/// Whether another attempt may be better than an uncertain pose: from the same candidate without
/// templates, or from the next candidate.
bool CandidateTrials::nextIsWorthwhile(const RunContext& run) const {
  if (matched_ >= 0) return true;
  if (!hasNext(run) || next_ >= static_cast<int>(candidates_.size())) return false;
  return candidates_[static_cast<std::size_t>(next_)].rank_nats() >
         candidates_.front().rank_nats() - kAboutAsMuch_nats;
}

Attempt CandidateTrials::next(int attempt, const RunContext& run) {
  const bool refines = matched_ >= 0;
  if (!refines && !hasPose() && triesSeed(run)) {
    seed_tried_ = true;
    return Attempt(attempt, seed_);
  }
  const int index = refines ? matched_ : next_++;
  const PoseCandidate& candidate = candidates_[static_cast<std::size_t>(index)];
  // A direction that the image does not determine, such as a turn about an axis of symmetry, may
  // have left the box.
  const Pose camera_from_station = pulledBack(seed_, candidate.camera_from_station);
  const bool is_fine = isWithinReach(candidate, run.levels.fine);
  const bool may_refine = run.options.refinement.enabled;
  matched_ = -1;
  if (refines || (may_refine && is_fine))
    return Attempt(attempt, seed_, camera_from_station, !is_fine, run.options.loop);
  if (may_refine) matched_ = index;
  return Attempt(attempt,
                 {camera_from_station, uncertaintyAbout(camera_from_station, seed_, run.scene)});
}

CandidateTrials::Next CandidateTrials::takePose(const Attempt& attempt,
                                                const Pose& camera_from_station_before,
                                                double probability, const RunContext& run) {
  if (returns_) return Next::kConclude;
  const bool leads = probability > best_probability_;
  if (leads) {
    best_probability_ = probability;
    best_ = attempt;
    best_before_ = camera_from_station_before;
  }
  if (best_probability_ < kSure && nextIsWorthwhile(run)) return Next::kTry;
  return leads ? Next::kConclude : Next::kReturn;
}

CandidateTrials::Next CandidateTrials::takeFailure(const RunContext& run) {
  if (returns_) return Next::kConclude;
  if (hasPose()) return nextIsWorthwhile(run) ? Next::kTry : Next::kReturn;
  return hasNext(run) ? Next::kTry : Next::kConclude;
}

Attempt CandidateTrials::best(int attempt, const LocalizerOptions& options) {
  returns_ = true;
  return best_.beforeLastIteration(attempt, best_before_, options);
}

}  // namespace boresight
