// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/handed_pose.h"

#include <algorithm>

#include "sessions/io/errors.h"
#include "sessions/review/checks.h"
#include "sessions/review/standing.h"
#include "sessions/session/case_marks.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {
namespace {

void takeDecision(const Decision& decision, HandedPose& pose) {
  pose.source = decision.pose->source;
  pose.camera_from_station = decision.pose->camera_from_station;
  pose.covariance = decision.pose->covariance;
  pose.run_digest = decision.digest;
  pose.checks = decision.checks;
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
  if (standing.holds() && standing.decision->pose)
    takeDecision(*standing.decision, pose);
  else if (run != nullptr && run->status == "converged")
    takeRun(*one, *run, pose);
  else
    takeMarks(session, *one, pose);
  return pose;
}

HandedPose checkedPose(const Session& session, const std::string& case_id,
                       std::shared_ptr<const LoadedCase> loaded) {
  HandedPose pose = handedPose(session, case_id);
  if (!pose.checks.empty()) return pose;
  if (!loaded) loaded = loadCase(*session.findCase(case_id));
  const ReviewSubject subject =
      reviewSubject(session, std::move(loaded), pose.source, pose.run_digest);
  pose.covariance = subject.covariance;
  const CheckLimits limits = checkLimits(session.review.preset, session.review.limits);
  for (const Check& check : checkPose(subject, limits)) pose.checks.push_back({check, ""});
  return pose;
}

std::optional<LocalizationTrace> traceOf(const Session& session, const HandedPose& pose) {
  const auto run = std::find_if(session.runs.begin(), session.runs.end(), [&](const auto& one) {
    return one.case_id == pose.case_id && one.digest == pose.run_digest;
  });
  if (run == session.runs.end()) return {};
  try {
    return loadRun(*run);
  } catch (const InputError&) {  // the pose stands without it
    return {};
  }
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
