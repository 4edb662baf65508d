// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/handed_pose.h"

#include <algorithm>

#include "sessions/io/errors.h"
#include "sessions/review/measured_pose.h"
#include "sessions/review/standing.h"
#include "sessions/session/case_marks.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {
namespace {

bool converged(const RunRecord* run) {
  return run != nullptr && run->status == localizationStatusText(LocalizationStatus::kConverged);
}

void takeRun(const SessionCase& one, const RunRecord& run, HandedPose& pose) {
  if (run.inputs_sha256 != inputsDigest(one))
    throw InputError(
        "session", "runs",
        "the inputs of case '" + one.id + "' have changed since its run: run it again");
  const LocalizationTrace trace = loadRun(run);
  pose.source = PoseSource::kRun;
  pose.camera_from_station = trace.camera_from_station;
  pose.run_digest = run.digest;
  pose.score = trace.support.share();
  pose.seconds = trace.seconds.total();
}

void takeMarks(const Session& session, const SessionCase& one, HandedPose& pose) {
  const CaseMarksSolution solved =
      solveCaseMarks(caseMarks(session, one.id), marksGuess(one), {}, false);
  const auto camera_from_station = solved.camera_from_station();
  if (!camera_from_station)
    throw InputError("session", "cases",
                     "case '" + one.id + "' has no pose: no run converged, and of its marks: " +
                         solved.result.reason);
  pose.source = PoseSource::kAnnotation;
  pose.camera_from_station = *camera_from_station;
}

/// What was decided on, which is what its source gives.
void takeDecision(const Decision& decision, HandedPose& pose) {
  const Pose camera_from_station = pose.camera_from_station;
  pose.camera_from_station = decision.pose->camera_from_station;
  pose.covariance = decision.pose->covariance;
  requireAsMeasured(pose.case_id, poseDifference(pose, camera_from_station));
  pose.score = 1.0;
  pose.checks = decision.checks;
}

}  // namespace

HandedPose handedPose(const Session& session, const std::string& case_id) {
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr) throw InputError("session", "cases", "there is no case '" + case_id + "'");
  HandedPose pose;
  pose.case_id = case_id;
  const Standing standing = standingOf(session, case_id);
  pose.validated = standing.state == CaseStanding::kValidated;
  pose.standing = standingText(standing);
  const RunRecord* run = session.lastRunOf(case_id);
  const Decision* decision = standing.judgedPose();
  const bool of_run =
      decision != nullptr ? decision->pose->source == PoseSource::kRun : converged(run);
  if (of_run && !converged(run))
    throw InputError("session", "decisions",
                     "the decision on case '" + case_id + "' is of a run that did not converge");
  if (of_run)
    takeRun(*one, *run, pose);
  else
    takeMarks(session, *one, pose);
  if (decision != nullptr) takeDecision(*decision, pose);
  return pose;
}

HandedPoses handedPoses(const Session& session, const std::vector<std::string>& case_ids) {
  for (const std::string& id : case_ids)
    if (session.findCase(id) == nullptr)
      throw InputError("session", "cases", "there is no case '" + id + "'");
  HandedPoses made;
  for (const auto& one : session.cases) {
    const bool asked = std::find(case_ids.begin(), case_ids.end(), one->id) != case_ids.end();
    if (!case_ids.empty() && !asked) continue;
    try {
      made.poses.push_back(handedPose(session, one->id));
    } catch (const InputError& error) {
      made.notes.push_back(error.what());
    }
  }
  return made;
}

}  // namespace boresight::sessions
