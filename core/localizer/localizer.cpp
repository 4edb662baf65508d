// SPDX-License-Identifier: Apache-2.0
// The loop: a policy plans a pass, the pass runs in slices, the policy rules on its outcome.
#include "core/localizer/localizer.h"

#include <optional>

#include "core/localizer/acceptance.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"

namespace boresight {

namespace {

/// Whether a refinement of the seed at the coarse level searches as far as its uncertainty moves
/// the scene.
bool reachesTruth(const Seed& seed, const RunContext& run) {
  return motionWithin_px(seed, run.scene, run.camera) <=
         kFirstRadius_px * levelScale(run.levels.coarse);
}

}  // namespace

StepReport Localizer::step() {
  if (phase_ == Phase::kEnded) return StepReport::end(false);
  if (status_ != Status::kOk)
    return finish(LocalizationStatus::kFault, StepReport::of(Stage::kEdges, true));
  if (!pass_.running()) pass_.begin(plan());
  const StepReport report = pass_.step();  // bounded; uses the arena only; writes the digest
  return pass_.running() ? report : decide(report);
}

/// The next pass of the current phase.
PassPlan Localizer::plan() const {
  PassPlan plan;
  switch (phase_) {
    case Phase::kEdges:  // the edges of the image
    case Phase::kEnded:
      break;
    case Phase::kNearSearch:  // refine a seed that is near the truth
      plan.kind = PassKind::kNearSearch;
      break;
    case Phase::kSearch:  // search the whole object over the seed's uncertainty
      plan.kind = PassKind::kSearch;
      break;
    case Phase::kIterate:  // match templates, solve, repeat; then refine on edges
      plan = attempt_.plan(pass_.context());
      if (searches()) comparison_.endAtKnown(plan);
      break;
    case Phase::kWeigh:  // measure the evidence for the converged pose
      plan.kind = PassKind::kEvidence;
      plan.record = attempt_.record();
      break;
    case Phase::kAccept:  // measure the support of the final pose
      plan.kind = PassKind::kSupport;
      plan.record = attempt_.record();
      if (searches())
        plan.evidence = comparison_.evidenceFor(attempt_.camera_from_station(), pass_.context());
      break;
    case Phase::kCompare:  // compare the final pose with what may contradict it
      plan.kind = comparison_kind_;
      plan.camera_from_station = attempt_.camera_from_station();
      break;
  }
  return plan;
}

/// The one place where policies meet.
StepReport Localizer::decide(StepReport report) {
  report.stage_complete = true;
  if (pass_.outcome().fault != Status::kOk)
    return fail({Ruling::Next::kFailed, LocalizationStatus::kFault, pass_.outcome().reached, true,
                 pass_.plan().record});
  switch (phase_) {
    case Phase::kEdges:
      phase_ = searches() ? Phase::kSearch : Phase::kIterate;
      if (!startsNear()) break;
      if (reachesTruth(seedOf(problem()), pass_.context()))
        startComparison();
      else
        phase_ = Phase::kNearSearch;
      break;
    case Phase::kNearSearch:
      if (workspace().candidates.empty()) return searchAll(report);
      startComparison();
      break;
    case Phase::kSearch:
      startComparison();
      break;
    case Phase::kIterate:
      return iterated(
          attempt_.take(pass_.outcome(), agreement(), pass_.context(), pass_.memory().records));
    case Phase::kWeigh:
      return weighed();
    case Phase::kAccept:
      return accepted(judgeSupport(workspace(), options(), searches()), report);
    case Phase::kCompare:
      return compared(report);
    case Phase::kEnded:
      break;
  }
  return report;
}

/// Follows the attempt's ruling: another pass, its pose, or its failure. An attempt that reaches a
/// known hypothesis ends.
StepReport Localizer::iterated(const Ruling& ruling) {
  if (ruling.failed()) return fail(ruling);
  const bool refined = workspace().iteration->kind == IterationKind::kRefine;
  if (searches() && refined &&
      comparison_.isKnown(attempt_.camera_from_station(), workspace().iteration->level,
                          pass_.context()))
    return follow(comparison_.takeFailure(pass_.context()), ruling.status, show(ruling));
  if (ruling.found())
    phase_ = searches() && !comparison_.returns() ? Phase::kWeigh : Phase::kAccept;
  return show(ruling);
}

/// Takes the pose as a hypothesis, unless a candidate's own box reached beyond the seed's.
StepReport Localizer::weighed() {
  const StepReport report = show({Ruling::Next::kPose, LocalizationStatus::kRunning,
                                  Stage::kSupport, false, attempt_.record()});
  const Pose& pose = attempt_.camera_from_station();
  if (leftUncertainty(seedOf(problem()), pose, options().loop.leave_factor))
    return follow(comparison_.takeFailure(pass_.context()), LocalizationStatus::kLeftUncertainty,
                  report);
  PoseHypothesis measured;
  measured.evidence = workspace().evidence;
  measured.score = measured.evidence.score();
  measured.probability = workspace().probability;
  const PoseComparison::Next next =
      comparison_.takePose(attempt_, workspace().iteration->camera_from_station_before, measured,
                           pass_.outcome().weak, edgePlaces(), pass_.context());
  comparison_.writeTo(pass_.context(), pass_.workspace());
  return follow(next, LocalizationStatus::kConverged, report);
}

/// Of the pose refined last; none where poses are matched only.
EdgePlaces Localizer::edgePlaces() const {
  const Iteration& iteration = *workspace().iteration;
  return iteration.kind == IterationKind::kRefine
             ? EdgePlaces(iteration.refinement, problem().camera)
             : EdgePlaces();
}

/// Judges the final pose, then compares it with poses that show about the same edges.
StepReport Localizer::accepted(LocalizationStatus status, const StepReport& report) {
  if (status != LocalizationStatus::kConverged)
    return fail({Ruling::Next::kFailed, status, Stage::kSupport, false, attempt_.record()});
  if (searches() && !comparison_.convinces(attempt_.camera_from_station(), workspace().probability))
    return follow(comparison_.takeFailure(pass_.context()), status, report);
  show({Ruling::Next::kPose, status, Stage::kSupport, false, attempt_.record()});
  covariance_ =
      withUndetermined(attempt_.covariance(), pass_.outcome().weak, problem().uncertainty);
  if (!searches() || !options().support.gate) return finish(status, report);
  status = judgeGap(workspace(), options());
  if (status != LocalizationStatus::kConverged) return conclude(status, report);
  phase_ = Phase::kCompare;
  comparison_kind_ = PassKind::kCompare;
  return report;
}

/// Judges the competing poses.
StepReport Localizer::compared(const StepReport& report) {
  const Seed seed = seedOf(problem());
  const LocalizationStatus status =
      judgeCompetingPoses(workspace().competing_poses, workspace().probability, seed, options());
  const std::optional<PassKind> next = comparisonAfter(comparison_kind_, workspace().probability,
                                                       seed, attempt_.camera_from_station());
  if (status != LocalizationStatus::kConverged || !next) return conclude(status, report);
  comparison_kind_ = *next;
  return report;
}

/// Ends the run, or goes on with the search: a pose that is ambiguous is not the last word while
/// candidates wait.
StepReport Localizer::conclude(LocalizationStatus status, const StepReport& report) {
  const bool goes_on = status != LocalizationStatus::kConverged && pass_.searchIsSuspended();
  return goes_on ? searchAll(report) : finish(status, report);
}

/// Whether the fault is a capacity that the render of a hypothesis exceeds: it may suffice for the
/// others.
bool Localizer::concernsOneHypothesis() const {
  const bool refines = phase_ == Phase::kIterate || phase_ == Phase::kWeigh;
  const Status fault = pass_.outcome().fault;
  return searches() && refines &&
         (fault == Status::kCapacityExceeded || fault == Status::kTooManyLayers);
}

/// After a failure: the next start, another attempt, or the end.
StepReport Localizer::fail(const Ruling& ruling) {
  const StepReport report = show(ruling);
  if (ruling.status == LocalizationStatus::kFault && !concernsOneHypothesis())
    return finish(ruling.status, report);
  if (searches()) return follow(comparison_.takeFailure(pass_.context()), ruling.status, report);
  if (attempt_.index() + 1 >= options().loop.max_attempts) return finish(ruling.status, report);
  attempt_.restart();
  iterate(attempt_);
  return report;
}

/// The whole object is searched next, or on, as the seed or the first candidate does not convince.
StepReport Localizer::searchAll(const StepReport& report) {
  attempt_ = Attempt(attempt_.index() + 1, seedOf(problem()));
  pass_.workspace().competing_poses = {};  // of a pose that did not convince
  phase_ = Phase::kSearch;
  return report;
}

StepReport Localizer::follow(PoseComparison::Next next, LocalizationStatus status,
                             const StepReport& report) {
  const int index = attempt_.index() + 1;
  if (next == PoseComparison::Next::kConclude) return finish(status, report);
  if (next == PoseComparison::Next::kSearch) return searchAll(report);
  iterate(next == PoseComparison::Next::kTry ? comparison_.next(index, pass_.context())
                                             : comparison_.best(index, options()));
  return report;
}

}  // namespace boresight
