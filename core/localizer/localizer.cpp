// SPDX-License-Identifier: Apache-2.0
// The loop: a policy plans a pass, the pass runs in slices, the policy rules on its outcome.
#include "core/localizer/localizer.h"

#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"

namespace boresight {

StepReport Localizer::step() {
  StepReport report = StepReport::of(Stage::kFinished, false);
  report.finished = true;
  if (phase_ == Phase::kEnded) return report;
  if (status_ != Status::kOk)
    return finish(LocalizationStatus::kFault, StepReport::of(Stage::kEdges, true));
  if (!pass_.running()) pass_.begin(plan());
  report = pass_.step();  // bounded; uses the arena only; writes the digest
  return pass_.running() ? report : decide(report);
}

/// What the policy in charge wants to be done next.
PassPlan Localizer::plan() const {
  PassPlan plan;
  switch (phase_) {
    case Phase::kSearch:  // where may the whole object be?
      plan.kind = PassKind::kSearch;
      return plan;
    case Phase::kIterate:  // match templates, solve, repeat; then refine on edges
      return attempt_.plan(pass_.context());
    case Phase::kAccept:  // does the image support the pose that converged?
      plan.kind = PassKind::kSupport;
      plan.record = attempt_.record();
      return plan;
    case Phase::kCompare:  // where else does the edge pattern of the model repeat?
      return competing_.comparison();
    case Phase::kTwins:  // does another pose show about the same edges?
      plan.kind = PassKind::kTwins;
      plan.camera_from_station = attempt_.camera_from_station();
      return plan;
    case Phase::kEdges:
    case Phase::kEnded:
      break;
  }
  return plan;  // the edges of the image
}

/// The one place where policies meet.
StepReport Localizer::decide(const StepReport& slice) {
  const PassOutcome& outcome = pass_.outcome();
  const bool prepares = phase_ == Phase::kEdges || phase_ == Phase::kSearch;
  if (outcome.fault == Status::kOk && prepares) {
    if (phase_ == Phase::kSearch) startTrials();
    if (phase_ == Phase::kEdges) phase_ = searches() ? Phase::kSearch : Phase::kIterate;
    return slice;
  }
  if (phase_ == Phase::kCompare)
    return follow(competing_.takeShifts(pass_.selfShifts(), pass_.context()), slice);
  if (phase_ == Phase::kTwins) return judgeTwins(slice);
  const Ruling ruling = rule(outcome);
  pass_.show(ruling);
  StepReport report = StepReport::of(ruling.stage, true);
  report.iteration_complete = ruling.iteration_complete;
  if (ruling.failed()) return retry(ruling, report);
  if (!ruling.found()) return report;  // another pass of the same policy
  if (phase_ == Phase::kIterate) {
    phase_ = Phase::kAccept;
    return report;
  }
  const Pose& before = workspace().iteration->camera_from_station_before;
  if (searches() && !competing_.hasStarted()) {
    const CandidateTrials::Next next =
        trials_.takePose(attempt_, before, outcome.probability, pass_.context());
    if (next != CandidateTrials::Next::kConclude)
      return follow(next, LocalizationStatus::kConverged, report);
  }
  if (!pass_.options().ambiguity.enabled) {
    if (!searches() || !pass_.options().support.gate)
      return finish(LocalizationStatus::kConverged, report);
    phase_ = Phase::kTwins;
    return report;
  }
  if (competing_.hasEnded())
    return finish(competing_.verdict(attempt_.camera_from_station(), pass_.options()), report);
  const double margin_nats = competing_.hasStarted() ? pass_.bestMargin_nats() : 0.0;
  bool leads = false;
  const CompetingPoses::Next next =
      competing_.takePose(attempt_, before, margin_nats, pass_.context(), leads);
  if (leads) pass_.keepBestRender();
  return follow(next, report);
}

Ruling Localizer::rule(const PassOutcome& outcome) {
  if (outcome.fault != Status::kOk)
    return {Ruling::Next::kFailed, LocalizationStatus::kFault, outcome.reached, true,
            pass_.plan().record};
  if (phase_ == Phase::kAccept) {
    // A candidate's own box may reach beyond the seed's.
    const bool left = searches() && !competing_.hasStarted() &&
                      leftUncertainty(seedOf(problem()), attempt_.camera_from_station(),
                                      pass_.options().loop.leave_factor);
    const SupportOptions& options = pass_.options().support;
    const bool supported = searches() ? isProbable(outcome.probability, options)
                                      : isSupported(outcome.support, options);
    const bool blurred = options.gate && !workspace().edge_width.isSharp();
    const bool mismatched = options.gate && workspace().focal.disagrees();
    // Widths and focal length are those of the image only where the pose is about right.
    const LocalizationStatus refusal = left         ? LocalizationStatus::kLeftUncertainty
                                       : !supported ? LocalizationStatus::kNotSupported
                                       : blurred    ? LocalizationStatus::kBlurred
                                                    : LocalizationStatus::kCameraMismatch;
    const bool accepted = supported && !left && !blurred && !mismatched;
    return {accepted ? Ruling::Next::kPose : Ruling::Next::kFailed, refusal, Stage::kSupport, false,
            attempt_.record()};
  }
  const Iteration& record = *workspace().iteration;
  return attempt_.take(outcome, {record.pnp.inlier_count, record.correspondence_count},
                       pass_.context(), pass_.memory().records);
}

StepReport Localizer::judgeTwins(StepReport report) {
  const std::span<const Rival> rivals = competing_.takeTwins(pass_.twins());
  pass_.workspace().rivals = rivals;
  digestRivals(rivals, pass_.digest());
  report.stage_complete = true;
  return finish(competing_.verdictOnTwins(pass_.options()), report);
}

/// After a failure: the next competing pose, another attempt, or the end.
StepReport Localizer::retry(const Ruling& ruling, StepReport report) {
  if (ruling.status == LocalizationStatus::kFault) return finish(ruling.status, report);
  if (competing_.isTrying()) return follow(competing_.takeFailure(ruling.status), report);
  if (competing_.hasStarted()) return finish(ruling.status, report);
  // Other candidates are seen by the same camera.
  if (ruling.status == LocalizationStatus::kCameraMismatch && !trials_.hasPose())
    return finish(ruling.status, report);
  if (searches())
    return follow(trials_.takeFailure(attempt_.index(), pass_.context()), ruling.status, report);
  if (attempt_.index() + 1 >= pass_.options().loop.max_attempts)
    return finish(ruling.status, report);
  attempt_.restart();
  iterate(attempt_);
  return report;
}

StepReport Localizer::follow(CandidateTrials::Next next, LocalizationStatus status,
                             StepReport report) {
  const int index = attempt_.index() + 1;
  if (next == CandidateTrials::Next::kConclude) return finish(status, report);
  iterate(next == CandidateTrials::Next::kTry ? trials_.next(index, pass_.context())
                                              : trials_.best(index, pass_.options()));
  return report;
}

StepReport Localizer::follow(CompetingPoses::Next next, StepReport report) {
  const int index = attempt_.index() + 1;
  pass_.workspace().rivals = competing_.poses();
  switch (next) {
    case CompetingPoses::Next::kCompare:
      phase_ = Phase::kCompare;
      return report;
    case CompetingPoses::Next::kTry:
      iterate(competing_.competitor(index, pass_.context()));
      return report;
    case CompetingPoses::Next::kReturn:
      digestRivals(competing_.poses(), pass_.digest());
      pass_.restoreBestRender();
      iterate(competing_.best(index, pass_.options()));
      return report;
    case CompetingPoses::Next::kConclude:
      digestRivals(competing_.poses(), pass_.digest());
      break;
  }
  return finish(competing_.verdict(attempt_.camera_from_station(), pass_.options()), report);
}

}  // namespace boresight
