// SPDX-License-Identifier: Apache-2.0
// The loop: one bounded slice per step.
#include "core/localizer/localizer.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {
StepReport Localizer::step() {
  if (status_ != Status::kOk && stage_ != Stage::kFinished) return faulted(stage_, status_);
  if (link_.need != ViewNeed::kNothing) return StepReport::of(stage_, false);
  if (iteration_pending_) startIteration();
  if (hypothesis_pending_) startHypothesis();
  switch (stage_) {
    case Stage::kEdges:
      return stepEdges();
    case Stage::kRender:
      return stepRender();
    case Stage::kTemplates:
      return stepTemplates();
    case Stage::kMatch:
      return stepMatch();
    case Stage::kPose:
      return stepPose();
    case Stage::kRefine:
      return stepRefine();
    case Stage::kSupport:
      return stepSupport();
    case Stage::kFinished:
      break;
  }
  StepReport finished = StepReport::of(Stage::kFinished, false);
  finished.finished = true;
  return finished;
}

Status Localizer::restart(const Pose& camera_from_station_seed, const LocalizerOptions& options) {
  if (!isUsable(PosePrior{camera_from_station_seed, problem_.uncertainty}))
    return Status::kInvalidPose;
  std::size_t bytes = 0;
  Status status = requiredBytes(sizeOf(problem_), options, workers_, bytes, kernels_);
  if (status == Status::kOk && bytes > memory_.size()) status = Status::kArenaTooSmall;
  if (status != Status::kOk) return status;
  problem_.camera_from_station_seed = camera_from_station_seed;
  options_ = options;
  begin();
  return status_;
}

bool Localizer::changeOptions(const LocalizerOptions& options) {
  if (!isBetweenIterations() || firstInvalidOption(options) != nullptr ||
      firstFixedOption(options_, options) != nullptr)
    return false;
  if (sameOptions(options_, options)) return true;
  options_ = options;
  selector_.setOptions(options.templates);
  refinement_.setOptions(options.refinement);
  digest_.tag("changed");
  digestOptions(options, digest_);
  return true;
}

void Localizer::startIteration() {
  iteration_pending_ = false;
  hypothesis_ = 0;
  has_best_ = false;
  current_ = 0;
  // The renderer works where the finer edge maps were.
  for (int level = 0; level < fine_level_; ++level)
    workspace_.edges.level[static_cast<std::size_t>(level)] = BitImage();
  hypothesis_pending_ = true;
}

void Localizer::startHypothesis() {
  hypothesis_pending_ = false;
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.index = workspace_.iterations;
  now.attempt = attempt_;
  now.status = LocalizationStatus::kRunning;
  if (isWide())
    placeRestart(now);
  else
    placeIteration(now);
  now.templates.count = 0;
  now.matches.count = 0;
  now.matches.searched = 0;
  now.correspondence_count = 0;
  now.pnp.inlier_count = 0;
  now.refinement.sample_count = 0;
  now.refinement.found_count = 0;
  now.refinement.used_count = 0;
  workspace_.iteration = &now;
  stage_ = Stage::kRender;
  stage_begun_ = false;
}

/// What the schedule asks of the iteration.
void Localizer::placeIteration(Iteration& now) {
  now.restarts = {};
  now.kind = isRefinement(options_, iteration_) ? IterationKind::kRefine : IterationKind::kMatch;
  now.level = now.kind == IterationKind::kMatch && iteration_ == 0 ? coarse_level_ : fine_level_;
  now.camera_from_station_before = camera_from_station_;
  now.uncertainty = link_.role == ViewRole::kFollows
                        ? link_.uncertainty
                        : uncertaintyAt(started_, options_.loop, iteration_, camera_from_station_);
  now.threshold_px = thresholdAt(options_, iteration_, now.level);
  if (!canReuseRender(now)) {
    now.render = now.level == coarse_level_ ? coarse_render_[static_cast<std::size_t>(current_)]
                                            : fine_render_;
  }
}

/// The last refinement's render shows the scene as it would be rendered again.
bool Localizer::canReuseRender(const Iteration& now) const {
  return now.kind == IterationKind::kRefine && iteration_ > options_.loop.match_iterations &&
         displacementBetween_px(now.render.camera_from_station, camera_from_station_, bounds_,
                                problem_.camera) < options_.loop.render_again_px;
}

HypothesisSummary Localizer::summaryOf(const Iteration& now) const {
  HypothesisSummary summary;
  summary.templates = now.templates.count;
  summary.matches = now.correspondence_count;
  summary.inliers = now.pnp.inlier_count;
  summary.solved = now.status == LocalizationStatus::kRunning;
  summary.camera_from_station = now.pnp.camera_from_station;
  for (std::int32_t i = 0; i < now.correspondence_count; ++i) {
    const double ratio =
        summary.solved ? now.pnp.residual_px[static_cast<std::size_t>(i)] / now.threshold_px : 1.0;
    summary.cost += std::min(1.0, ratio * ratio);
  }
  return summary;
}

void Localizer::noteHypothesis() {
  HypothesisSummary summary = summaryOf(buffers_[static_cast<std::size_t>(current_)]);
  summary.roll_rad = rollOf(hypothesis_, options_.loop.roll_spacing_rad);
  for (Iteration& buffer : buffers_) {
    buffer.hypotheses[static_cast<std::size_t>(hypothesis_)] = summary;
    buffer.hypothesis_count = hypothesis_ + 1;
  }
}

/// Too little to go on with. Another hypothesis may have more: it counts as one without a pose.
StepReport Localizer::failHypothesis(Stage stage, LocalizationStatus status) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.status = status;
  if (link_.role != ViewRole::kAlone) return leaveToOthers(stage, status);
  if (now.kind == IterationKind::kRefine) return fail(stage, status);
  now.pnp.inlier_count = 0;
  now.pnp.camera_from_station = camera_from_station_;
  return finishHypothesis(stage);
}

StepReport Localizer::finishHypothesis(Stage stage) {
  if (isWide()) return finishRestart(stage, {});
  reached_[static_cast<std::size_t>(current_)] = stage;
  noteHypothesis();
  const int other = 1 - current_;
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Iteration& best = buffers_[static_cast<std::size_t>(other)];
  Agreement& agreement = agreement_[static_cast<std::size_t>(current_)];
  if (link_.role == ViewRole::kAlone) agreement = {now.pnp.inlier_count, now.correspondence_count};
  const bool better =
      !has_best_ || agreement.inliers > agreement_[static_cast<std::size_t>(other)].inliers;
  buffers_[static_cast<std::size_t>(better ? current_ : other)].chosen_hypothesis =
      better ? hypothesis_ : best.chosen_hypothesis;
  const int kept = better ? current_ : other;
  ++hypothesis_;
  const int wanted = iteration_ == 0 ? rolledHypotheses(options_, started_.uncertainty) : 1;
  if (hypothesis_ < wanted && !isConvincing(kept)) {
    has_best_ = true;
    current_ = 1 - kept;
    // Started by the next step: until then the caller sees the hypothesis that has ended.
    hypothesis_pending_ = true;
    return StepReport::of(stage, true);
  }
  current_ = kept;
  Iteration& chosen = buffers_[static_cast<std::size_t>(kept)];
  workspace_.iteration = &chosen;
  if (chosen.status != LocalizationStatus::kRunning)
    return fail(reached_[static_cast<std::size_t>(kept)], chosen.status);
  return finishIteration(Stage::kPose, chosen.pnp.camera_from_station, chosen.pnp.covariance);
}

/// So many matches agree by chance with no pose. A further attempt looks at every roll.
bool Localizer::isConvincing(int buffer) const {
  const auto index = static_cast<std::size_t>(buffer);
  return attempt_ == 0 && buffers_[index].status == LocalizationStatus::kRunning &&
         agreement_[index].inliers >=
             options_.loop.enough_inliers * agreement_[index].correspondences;
}

StepReport Localizer::finishIteration(Stage stage, const Pose& camera_from_station,
                                      const Matrix6d& covariance) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const bool matched = now.kind == IterationKind::kMatch;
  const bool pull = options_.loop.anchored && matched && options_.refinement.enabled;
  now.camera_from_station = pull ? pulledBack(started_, camera_from_station) : camera_from_station;
  measureCorrection(camera_from_station_, now.camera_from_station);
  small_corrections_ = isSmall(now) ? small_corrections_ + 1 : 0;
  camera_from_station_ = now.camera_from_station;
  covariance_ = covariance;
  if (matched && options_.templates.learn) learn();
  if (matched) {
    // Templates overlap and share their errors.
    matched_.camera_from_station = camera_from_station_;
    if (!invert(covariance * options_.loop.match_inflation, matched_.information))
      matched_.information.setZero();
  }
  StepReport made = StepReport::of(stage, true);
  made.iteration_complete = true;
  ++iteration_;
  ++workspace_.iterations;
  if (leftUncertainty(started_, camera_from_station_, options_.loop.leave_factor))
    return fail(stage, LocalizationStatus::kLeftUncertainty);
  if (iteration_ >= iterationsNeeded(options_) &&
      small_corrections_ >= options_.loop.converged_iterations) {
    stage_ = Stage::kSupport;
    return made;
  }
  if (iteration_ >= options_.loop.max_iterations)
    return fail(stage, LocalizationStatus::kIterationLimit);
  // Started by the next step: until then the caller sees the iteration that has ended.
  iteration_pending_ = true;
  return made;
}

void Localizer::measureCorrection(const Pose& before, const Pose& after) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.correction_translation_m =
      translationBetween_m(before, after, bounds_, options_.loop.correction_point);
  now.correction_image_px = displacementBetween_px(before, after, bounds_, problem_.camera);
  now.correction_rotation_rad = rotationBetween_rad(before, after);
}

bool Localizer::isSmall(const Iteration& iteration) const {
  if (iteration.correction_image_px < options_.loop.converged_image_px) return true;
  return iteration.correction_translation_m < options_.loop.converged_translation_m &&
         iteration.correction_rotation_rad < options_.loop.converged_rotation_rad;
}

StepReport Localizer::fail(Stage stage, LocalizationStatus status) {
  if (rival_round_ == RivalRound::kRivals && status != LocalizationStatus::kFault)
    return endRival(stage, status);
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.status = status;
  StepReport made = StepReport::of(stage, true);
  made.iteration_complete = workspace_.iteration != nullptr;  // a fault may come before the first
  // One whose pose came out has been counted.
  if (made.iteration_complete && now.index == workspace_.iterations) ++workspace_.iterations;
  if (status != LocalizationStatus::kFault && canTryAgain()) {
    startAttempt();
    return made;
  }
  finish(status);
  made.finished = true;
  return made;
}

bool Localizer::canTryAgain() const {
  if (attempt_ + 1 >= options_.loop.max_attempts || rival_round_ != RivalRound::kNone) return false;
  return !options_.wide.isOn() || (!isWide() && bestFinalistLeft() >= 0);
}

/// From the seed again, with other templates and other samples: what failed may have been one of
/// them. After a wide search from what it found next best.
void Localizer::startAttempt() {
  ++attempt_;
  workspace_.attempts = attempt_ + 1;
  iteration_ = 0;
  small_corrections_ = 0;
  failed_count_ = 0;
  camera_from_station_ = problem_.camera_from_station_seed;
  iteration_pending_ = true;
  if (options_.wide.isOn()) startFinalist(bestFinalistLeft());
}

StepReport Localizer::faulted(Stage stage, Status fault) {
  workspace_.fault = fault;
  return fail(stage, LocalizationStatus::kFault);
}

void Localizer::finish(LocalizationStatus status) {
  workspace_.status = status;
  const bool converged = status == LocalizationStatus::kConverged;
  workspace_.camera_from_station =
      converged ? camera_from_station_ : problem_.camera_from_station_seed;
  if (converged) workspace_.covariance = covariance_;
  digest_.tag(localizationStatusText(status));
  digestPose(workspace_.camera_from_station, digest_);
  stage_ = Stage::kFinished;
}

}  // namespace boresight
