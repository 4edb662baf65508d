// SPDX-License-Identifier: Apache-2.0
// The loop: a policy plans a pass, the pass runs in slices, the policy rules on its outcome.
#include "core/localizer/localizer.h"

#include "core/localizer/acceptance.h"

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

/// The next pass of the current phase.
PassPlan Localizer::plan() const {
  PassPlan plan;
  switch (phase_) {
    case Phase::kEdges:  // the edges of the image
    case Phase::kEnded:
      break;
    case Phase::kSearch:  // search the whole object over the seed's uncertainty
      plan.kind = PassKind::kSearch;
      break;
    case Phase::kIterate:  // match templates, solve, repeat; then refine on edges
      return attempt_.plan(pass_.context());
    case Phase::kAccept:  // measure the support of the converged pose
      plan.kind = PassKind::kSupport;
      plan.record = attempt_.record();
      break;
    case Phase::kCompare:  // compare with other poses that show about the same edges
      plan.kind = PassKind::kCompare;
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
      break;
    case Phase::kSearch:
      startTrials();
      break;
    case Phase::kIterate:
      return iterated(
          attempt_.take(pass_.outcome(), agreement(), pass_.context(), pass_.memory().records));
    case Phase::kAccept:
      return accepted(judgeSupport(workspace(), seedOf(problem()), attempt_.camera_from_station(),
                                   options(), searches()),
                      report);
    case Phase::kCompare:
      return finish(judgeCompetingPoses(workspace().competing_poses, seedOf(problem()), options()),
                    report);
    case Phase::kEnded:
      break;
  }
  return report;
}

/// Follows the attempt's ruling: another pass, its pose, or its failure.
StepReport Localizer::iterated(const Ruling& ruling) {
  if (ruling.failed()) return fail(ruling);
  if (ruling.found()) phase_ = Phase::kAccept;
  return show(ruling);
}

/// Compares the pose with those of other candidates, then with poses that show about the same
/// edges.
StepReport Localizer::accepted(LocalizationStatus status, const StepReport& report) {
  if (status != LocalizationStatus::kConverged)
    return fail({Ruling::Next::kFailed, status, Stage::kSupport, false, attempt_.record()});
  show({Ruling::Next::kPose, status, Stage::kSupport, false, attempt_.record()});
  if (!searches()) return finish(status, report);
  const CandidateTrials::Next next =
      trials_.takePose(attempt_, workspace().iteration->camera_from_station_before,
                       pass_.outcome().probability, pass_.context());
  if (next != CandidateTrials::Next::kConclude) return follow(next, status, report);
  if (!options().support.gate) return finish(status, report);
  phase_ = Phase::kCompare;
  return report;
}

/// After a failure: the next candidate, another attempt, or the end.
StepReport Localizer::fail(const Ruling& ruling) {
  const StepReport report = show(ruling);
  // Other candidates are seen by the same camera.
  const bool concludes =
      ruling.status == LocalizationStatus::kFault ||
      (ruling.status == LocalizationStatus::kCameraMismatch && !trials_.hasPose());
  if (concludes) return finish(ruling.status, report);
  if (searches()) return follow(trials_.takeFailure(pass_.context()), ruling.status, report);
  if (attempt_.index() + 1 >= options().loop.max_attempts) return finish(ruling.status, report);
  attempt_.restart();
  iterate(attempt_);
  return report;
}

StepReport Localizer::follow(CandidateTrials::Next next, LocalizationStatus status,
                             const StepReport& report) {
  const int index = attempt_.index() + 1;
  if (next == CandidateTrials::Next::kConclude) return finish(status, report);
  iterate(next == CandidateTrials::Next::kTry ? trials_.next(index, pass_.context())
                                              : trials_.best(index, options()));
  return report;
}

}  // namespace boresight
