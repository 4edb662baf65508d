// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/pose_comparison.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/localizer/acceptance.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"

namespace boresight {
namespace {

// Uncertainty that remains after the search, as shares of the object's size and of its depth, and
// in rotation.
constexpr double kLateral = 0.03;
constexpr double kDepth = 0.04;
constexpr double kRotation_rad = 4.0 * kDegree_rad;

/// A candidate with a smaller share of the search's best total evidence cannot overtake: the best
/// poses of 177 runs came from candidates with 0.67 and more.
constexpr double kOfBestTotal = 0.5;
/// Share of its search radius over which a refinement converges reliably.
constexpr double kOfRadius = 0.67;
/// Poses nearer than this are one hypothesis, px of the level.
constexpr double kSame_px = 0.6;
/// The evidence holds for poses nearer than this, as a share of the object's longer side: half a
/// pixel of the finest view.
constexpr double kSameEvidence = 0.5 / kEvidenceSpan_px.back();
/// Motion of a restart, px of the fine level, root mean square.
constexpr double kRestart_px = 7.0;

/// Largest motion of the scene within a near seed's uncertainty, as a share of its longer side.
constexpr double kNear = 0.1;

/// Whether a refinement on edges at the level converges from the candidate's pose.
bool isWithinReach(const PoseCandidate& candidate, int level) {
  return candidate.error_px <= kOfRadius * kFirstRadius_px * levelScale(level);
}

/// Poses nearer than this at a level are one hypothesis, px of the full image.
double sameAt_px(int level) { return kSame_px * levelScale(level); }

}  // namespace

bool isNear(const Seed& seed, const RunContext& run) {
  return motionWithin_px(seed, run.scene, run.camera) <=
         kNear * longerSide_px(seed.camera_from_station, run.scene, run.camera);
}

bool PoseComparison::convinces(const Pose& camera_from_station, double probability) const {
  return !searches_on_ ||
         (probability >= kUndoubted && !leftUncertainty(seed_, camera_from_station, 1.0));
}

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

/// Whether the best pose so far needs no further search.
bool PoseComparison::bestConvinces() const {
  return hasPose() && convinces(hypotheses_[best_index_].camera_from_station,
                                hypotheses_[best_index_].probability);
}

/// Whether the source has a further start.
bool PoseComparison::offers(Source source, const RunContext& run) const {
  switch (source) {
    case Source::kNearSeed:
      return next_ == 0;
    case Source::kCandidates:
      return !(searches_on_ && bestConvinces()) &&
             firstCandidateFrom(next_) < static_cast<int>(candidates_.size());
    case Source::kTemplates:
      return next_ == 0 && !candidates_.empty() && run.options.refinement.enabled &&
             !isWithinReach(candidates_.front(), run.levels.fine);
    case Source::kSeed:
      return next_ == 0 && !searches_on_ &&
             (!hasPose() ||
              hypotheses_[best_index_].probability < run.options.support.min_probability);
    case Source::kRestarts:
      return next_ < kRestarts && bestConvinces() && (next_ > 0 ? restarted_ : weak_).known;
    case Source::kNone:
      break;
  }
  return false;
}

/// Index of the first candidate from `index` on that may have the most evidence once refined.
int PoseComparison::firstCandidateFrom(int index) const {
  double most_nats = 0.0;
  for (const PoseCandidate& candidate : candidates_)
    most_nats = std::max(most_nats, candidate.evidence.total_nats());
  const auto count = static_cast<int>(candidates_.size());
  while (index < count && nth(candidates_, index).evidence.total_nats() < kOfBestTotal * most_nats)
    ++index;
  return index;
}

/// Moves to the next source that has a start; false when there is none. Templates of a large object
/// come first, then candidates, the seed and restarts.
bool PoseComparison::findNext(const RunContext& run) {
  while (source_ != Source::kNone && !offers(source_, run)) {
    source_ = static_cast<Source>(static_cast<int>(source_) + 1);
    next_ = 0;
  }
  return source_ != Source::kNone;
}

Attempt PoseComparison::next(int attempt, const RunContext& run) {
  Attempt started = start(attempt, run);
  if (run.options.refinement.enabled && !returns_) started.draft();
  return started;
}

Attempt PoseComparison::start(int attempt, const RunContext& run) {
  if (!findNext(run)) return Attempt(attempt, seed_);
  if (source_ == Source::kCandidates) next_ = firstCandidateFrom(next_);
  const int number = next_++;
  current_ = {};
  current_.number = number;
  const bool refines = run.options.refinement.enabled;
  switch (source_) {
    case Source::kNearSeed:
      if (candidates_.empty())
        return Attempt(attempt, seed_, seed_.camera_from_station, true, run.options.loop);
      [[fallthrough]];
    case Source::kCandidates: {
      const PoseCandidate& candidate = nth(candidates_, number);
      // A direction that the image does not determine, such as a turn about an axis of symmetry,
      // may have left the box.
      const Pose start = pulledBack(seed_, candidate.camera_from_station);
      if (!refines) return Attempt(attempt, {start, uncertaintyAbout(start, seed_, run.scene)});
      return Attempt(attempt, seed_, start, !isWithinReach(candidate, run.levels.fine),
                     run.options.loop);
    }
    case Source::kTemplates: {
      current_.origin = HypothesisOrigin::kTemplates;
      const Pose start = pulledBack(seed_, candidates_.front().camera_from_station);
      return Attempt(attempt, {start, uncertaintyAbout(start, seed_, run.scene)});
    }
    case Source::kRestarts:
      current_.origin = HypothesisOrigin::kRestart;
      return restart(attempt, run);
    case Source::kSeed:
    case Source::kNone:
      break;
  }
  current_.origin = HypothesisOrigin::kSeed;
  return Attempt(attempt, seed_);
}

/// The best pose moved to either side along one of its weak directions.
Attempt PoseComparison::restart(int attempt, const RunContext& run) {
  if (current_.number == 0) {
    restarted_ = weak_;
    restarted_from_ = hypotheses_[best_index_].camera_from_station;
  }
  const double side = current_.number % 2 == 0 ? 1.0 : -1.0;
  const double motion_px = side * kRestart_px * levelScale(run.levels.fine);
  Attempt started(attempt, seed_, restarted_.moved(restarted_from_, current_.number / 2, motion_px),
                  true, run.options.loop);
  // A pose that does not convince may be far from the right one: each restart has its own render.
  if (searches_on_) started.renderFrom(restarted_from_);
  return started;
}

bool PoseComparison::isKnown(const Pose& camera_from_station, int level,
                             const RunContext& run) const {
  return !returns_ &&
         isKnownPose(camera_from_station, hypotheses(), sameAt_px(level), run.scene, run.camera);
}

void PoseComparison::endAtKnown(PassPlan& plan) const {
  if (returns_) return;
  plan.known = hypotheses();
  plan.known_px = sameAt_px(plan.level);
}

const PoseEvidence* PoseComparison::evidenceFor(const Pose& camera_from_station,
                                                const RunContext& run) const {
  if (!hasPose()) return nullptr;
  const PoseHypothesis& best = hypotheses_[best_index_];
  const double moved_px =
      displacementBetween_px(best.camera_from_station, camera_from_station, run.scene, run.camera);
  return moved_px < kSameEvidence * longerSide_px(camera_from_station, run.scene, run.camera)
             ? &best.evidence
             : nullptr;
}

PoseComparison::Next PoseComparison::takePose(const Attempt& attempt,
                                              const Pose& camera_from_station_before,
                                              const PoseHypothesis& measured,
                                              const WeakDirections& weak, const EdgePlaces& edges,
                                              const RunContext& run) {
  if (returns_) return Next::kConclude;
  current_.camera_from_station = attempt.camera_from_station();
  current_.evidence = measured.evidence;
  current_.score = measured.score;
  current_.probability = measured.probability;
  if (best_index_ < 0 || current_.score > hypotheses_[best_index_].score) {
    best_index_ = hypotheses_.size();
    best_ = attempt;
    best_before_ = camera_from_station_before;
    weak_ = weak;
    edges_ = edges;
  }
  hypotheses_.add(current_);
  return takeFailure(run);
}

PoseComparison::Next PoseComparison::takeFailure(const RunContext& run) {
  if (returns_) return searches_on_ ? Next::kSearch : Next::kConclude;
  if (findNext(run)) return Next::kTry;
  if (searches_on_ && !bestConvinces()) return Next::kSearch;
  return hasPose() ? Next::kReturn : Next::kConclude;
}

Attempt PoseComparison::best(int attempt, const LocalizerOptions& options) {
  returns_ = true;
  return best_.beforeLastIteration(attempt, best_before_, options);
}

int PoseComparison::competitorIndex(const RunContext& run) const {
  int competitor = -1;
  if (best_index_ < 0) return competitor;
  const Pose& best = hypotheses_[best_index_].camera_from_station;
  for (int i = 0; i < hypotheses_.size(); ++i) {
    const PoseHypothesis& other = hypotheses_[i];
    if (i == best_index_ || (competitor >= 0 && other.score <= hypotheses_[competitor].score) ||
        !areDistinct(best, edges_, other.camera_from_station, run.scene, run.camera))
      continue;
    competitor = i;
  }
  return competitor;
}

double PoseComparison::gap(const RunContext& run) const {
  const int competitor = competitorIndex(run);
  return competitor < 0 ? 0.0 : hypotheses_[best_index_].score - hypotheses_[competitor].score;
}

void PoseComparison::writeTo(const RunContext& run, Workspace& workspace) const {
  workspace.hypotheses = hypotheses();
  workspace.best_hypothesis = best_index_;
  workspace.competitor = competitorIndex(run);
  workspace.gap = gap(run);
}

}  // namespace boresight
