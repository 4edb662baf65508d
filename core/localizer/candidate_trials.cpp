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

/// Whether a refinement on edges converges from the candidate's pose.
bool isWithinReach(const PoseCandidate& candidate, const RunContext& run) {
  return run.options.refinement.enabled &&
         candidate.error_px <=
             kOfRadius * kFirstRadius_px * static_cast<double>(1 << run.levels.fine);
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

/// The last of several attempts starts from the seed.
bool CandidateTrials::triesSeed(int attempt, const RunContext& run) const {
  return next_ >= static_cast<int>(candidates_.size()) ||
         (attempt > 0 && attempt + 1 >= run.options.loop.max_attempts);
}

bool CandidateTrials::hasNext(int attempt, const RunContext& run) const {
  return attempt < run.options.loop.max_attempts && !seed_tried_;
}

/// Whether another attempt may be better than an uncertain pose: from the same candidate without
/// templates, or from the next candidate.
bool CandidateTrials::nextIsWorthwhile(int attempt, const RunContext& run) const {
  if (!hasNext(attempt, run)) return false;
  if (matched_ >= 0) return true;
  if (next_ >= static_cast<int>(candidates_.size())) return false;
  return candidates_[static_cast<std::size_t>(next_)].rank_nats() >
         candidates_.front().rank_nats() - kAboutAsMuch_nats;
}

Attempt CandidateTrials::next(int attempt, const RunContext& run) {
  if (!hasPose() && triesSeed(attempt, run)) {
    seed_tried_ = true;
    matched_ = -1;
    return Attempt(attempt, seed_);
  }
  const bool refines = hasPose() && matched_ >= 0;
  const int index = refines ? matched_ : next_++;
  const PoseCandidate& candidate = candidates_[static_cast<std::size_t>(index)];
  // A direction that the image does not determine, such as a turn about an axis of symmetry, may
  // have left the box.
  const Pose camera_from_station = pulledBack(seed_, candidate.camera_from_station);
  matched_ = -1;
  if (refines || isWithinReach(candidate, run))
    return Attempt(attempt, seed_, run.options.loop.match_iterations, camera_from_station);
  if (run.options.refinement.enabled) matched_ = index;
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
  if (best_probability_ < kSure && nextIsWorthwhile(attempt.index() + 1, run)) return Next::kTry;
  return leads ? Next::kConclude : Next::kReturn;
}

CandidateTrials::Next CandidateTrials::takeFailure(int attempt, const RunContext& run) {
  if (returns_) return Next::kConclude;
  if (hasPose()) return nextIsWorthwhile(attempt + 1, run) ? Next::kTry : Next::kReturn;
  return hasNext(attempt + 1, run) ? Next::kTry : Next::kConclude;
}

Attempt CandidateTrials::best(int attempt, const LocalizerOptions& options) {
  returns_ = true;
  return best_.beforeLastIteration(attempt, best_before_, options);
}

}  // namespace boresight
