// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/attempt.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"

namespace boresight {
namespace {

/// Factor on the matched pose's covariance when the refinement starts from that pose: templates
/// overlap and share their errors.
constexpr double kMatchInflation = 8.0;
/// Edge places of a draft.
constexpr std::int32_t kDraftSamples = 4000;

Ruling failed(Stage stage, LocalizationStatus status, int record) {
  return {Ruling::Next::kFailed, status, stage, true, record};
}

bool isSmall(const Iteration& iteration, const LoopOptions& loop) {
  if (iteration.correction_image_px < loop.converged_image_px) return true;
  return iteration.correction_translation_m < loop.converged_translation_m &&
         iteration.correction_rotation_rad < loop.converged_rotation_rad;
}

}  // namespace

Attempt::Attempt(int index, const Seed& seed, int iteration)
    : index_(index),
      iteration_(iteration),
      seed_(seed),
      camera_from_station_(seed.camera_from_station) {
  anchor_ = {seed.camera_from_station, scaled(seed.uncertainty, kUniformSigma)};
}

Attempt::Attempt(int index, const Seed& seed, const Pose& camera_from_station, bool coarse_first,
                 const LoopOptions& loop)
    : Attempt(index, seed, loop.match_iterations) {
  camera_from_station_ = camera_from_station;
  coarse_first_ = coarse_first;
}

void Attempt::restart() {
  ++index_;
  size_index_ = index_;
  iteration_ = 0;
  coarse_first_ = false;
  small_corrections_ = 0;
  camera_from_station_ = seed_.camera_from_station;
  startIteration();
}

void Attempt::startIteration() {
  hypothesis_ = 0;
  record_ = 0;
  has_best_ = false;
}

PassPlan Attempt::plan(const RunContext& run) const {
  const LoopOptions& loop = run.options.loop;
  const bool refines = isRefinement(run.options, iteration_);
  PassPlan plan;
  plan.kind = refines ? PassKind::kRefine : PassKind::kMatch;
  plan.record = record_;
  plan.attempt = index_;
  const bool coarse = coarse_first_ || (!refines && iteration_ == 0);
  plan.level = coarse ? run.levels.coarse : run.levels.fine;
  const bool shares_render = coarse_first_ && coarse_render_.has_value();
  plan.camera_from_station = camera_from_station_;
  plan.rendered_from_station = shares_render ? *coarse_render_ : camera_from_station_;
  plan.roll_rad = rollOf(hypothesis_);
  plan.uncertainty = uncertaintyAt(seed_, loop, iteration_, camera_from_station_);
  plan.threshold_px = thresholdAt(run.options, iteration_, plan.level);
  plan.template_factor = templateFactor(size_index_);
  const bool refined_before = refines && iteration_ > loop.match_iterations;
  plan.keep_render_px = refined_before || shares_render ? loop.render_again_px : 0.0;
  plan.most_samples = is_draft_ ? kDraftSamples : 0;
  plan.anchored = loop.anchored;
  plan.anchor = anchor_;
  plan.matched = matched_;
  return plan;
}

Ruling Attempt::take(const PassOutcome& outcome, const Agreement& agreement, const RunContext& run,
                     std::span<Iteration, 2> records) {
  Iteration& record = nth(records, record_);
  if (record.kind == IterationKind::kMatch) return takeHypothesis(outcome, agreement, run, records);
  if (record.status != LocalizationStatus::kRunning)
    return failed(outcome.reached, record.status, record_);
  return finishIteration(Stage::kRefine, record.refinement.camera_from_station,
                         record.refinement.covariance, run, record);
}

/// Keeps the hypothesis with most inliers; ends the iteration after the last one.
Ruling Attempt::takeHypothesis(const PassOutcome& outcome, const Agreement& agreement,
                               const RunContext& run, std::span<Iteration, 2> records) {
  const auto current = static_cast<std::size_t>(record_);
  const std::size_t best = 1 - current;
  reached_[current] = outcome.reached;
  agreement_[current] = agreement;
  HypothesisSummary summary = summaryOf(records[current]);
  summary.roll_rad = rollOf(hypothesis_);
  for (Iteration& record : records) {
    nth(record.hypotheses, hypothesis_) = summary;
    record.hypothesis_count = hypothesis_ + 1;
  }
  const bool better = !has_best_ || agreement.inliers > agreement_[best].inliers;
  if (better) records[current].chosen_hypothesis = hypothesis_;
  const std::size_t kept = better ? current : best;
  ++hypothesis_;
  const int wanted = iteration_ == 0 ? rolledHypotheses(run.options, seed_.uncertainty) : 1;
  if (hypothesis_ < wanted &&
      !isConvincing(static_cast<int>(kept), records[kept], run.options.loop)) {
    const int shown = record_;
    has_best_ = true;
    record_ = static_cast<int>(1 - kept);
    return {Ruling::Next::kPass, LocalizationStatus::kRunning, outcome.reached, false, shown};
  }
  record_ = static_cast<int>(kept);
  Iteration& chosen = records[kept];
  if (chosen.status != LocalizationStatus::kRunning)
    return failed(reached_[kept], chosen.status, record_);
  return finishIteration(Stage::kPose, chosen.pnp.camera_from_station, chosen.pnp.covariance, run,
                         chosen);
}

/// Whether more matches agree than chance explains. A later attempt tries every roll.
bool Attempt::isConvincing(int record, const Iteration& iteration, const LoopOptions& loop) const {
  const Agreement& agreement = nth(agreement_, record);
  return index_ == 0 && iteration.status == LocalizationStatus::kRunning &&
         agreement.inliers >= loop.enough_inliers * agreement.correspondences;
}

Ruling Attempt::finishIteration(Stage stage, const Pose& camera_from_station,
                                const Matrix6d& covariance, const RunContext& run,
                                Iteration& record) {
  const LoopOptions& loop = run.options.loop;
  const bool matched = record.kind == IterationKind::kMatch;
  const bool pulls = loop.anchored && matched && run.options.refinement.enabled;
  record.camera_from_station = pulls ? pulledBack(seed_, camera_from_station) : camera_from_station;
  measureCorrection(camera_from_station_, record.camera_from_station, run, record);
  small_corrections_ = isSmall(record, loop) ? small_corrections_ + 1 : 0;
  camera_from_station_ = record.camera_from_station;
  covariance_ = covariance;
  if (matched) {
    matched_.camera_from_station = camera_from_station_;
    if (!invert(covariance * kMatchInflation, matched_.information)) matched_.information.setZero();
  }
  // The first refinement of the fine level follows.
  if (!coarse_first_) ++iteration_;
  coarse_first_ = false;
  Ruling ruling{Ruling::Next::kPass, LocalizationStatus::kRunning, stage, true, record_};
  if (leftUncertainty(seed_, camera_from_station_, loop.leave_factor))
    return failed(stage, LocalizationStatus::kLeftUncertainty, record_);
  if (iteration_ >= iterationsNeeded(run.options) &&
      small_corrections_ >= (is_draft_ ? 1 : loop.converged_iterations)) {
    ruling.next = Ruling::Next::kPose;
    return ruling;
  }
  if (iteration_ >= loop.max_iterations)
    return failed(stage, LocalizationStatus::kIterationLimit, record_);
  startIteration();
  return ruling;
}

Ruling Attempt::goOn(const RunContext& run) {
  if (iteration_ >= run.options.loop.max_iterations)
    return {Ruling::Next::kFailed, LocalizationStatus::kIterationLimit, Stage::kSupport, false,
            record_};
  const int shown = record_;
  small_corrections_ = 0;
  startIteration();
  return {Ruling::Next::kPass, LocalizationStatus::kRunning, Stage::kSupport, false, shown};
}

Attempt Attempt::beforeLastIteration(int index, const Pose& camera_from_station_before,
                                     const LocalizerOptions& options) const {
  Attempt again = *this;
  again.index_ = index;
  again.is_draft_ = false;
  // With all iterations ahead that a refinement may need.
  again.iteration_ = std::min(iteration_, iterationsNeeded(options)) - 1;
  again.camera_from_station_ = camera_from_station_before;
  again.small_corrections_ = options.loop.converged_iterations - 1;
  again.startIteration();
  return again;
}

HypothesisSummary summaryOf(const Iteration& iteration) {
  HypothesisSummary summary;
  summary.templates = iteration.templates.count;
  summary.matches = iteration.correspondence_count;
  summary.inliers = iteration.pnp.inlier_count;
  summary.solved = iteration.status == LocalizationStatus::kRunning;
  summary.camera_from_station = iteration.pnp.camera_from_station;
  for (std::int32_t i = 0; i < iteration.correspondence_count; ++i) {
    const double ratio =
        summary.solved ? nth(iteration.pnp.residual_px, i) / iteration.threshold_px : 1.0;
    summary.cost += std::min(1.0, ratio * ratio);
  }
  return summary;
}

}  // namespace boresight
