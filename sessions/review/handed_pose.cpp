// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/validated_pose_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sessions/checks/checks.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"
#include "sessions/session/rig_links.h"
#include "sessions/session/views_run.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

bool converged(const RunRecord* run) {
  return run != nullptr && run->status == localizationStatusText(LocalizationStatus::kConverged);
}

void takeRun(const RunRecord& run, HandedPose& pose) {
  const LocalizationTrace trace = loadRun(run);
  pose.source = PoseSource::kRun;
  pose.camera_from_station = trace.camera_from_station;
  pose.run_digest = run.digest;
  pose.score = trace.support.share();
  pose.seconds = trace.seconds.total();
}

void takeAnnotations(const Session& session, const SessionCase& session_case, HandedPose& pose) {
  const CaseAnnotationsSolution solved = solveCaseAnnotations(
      caseAnnotations(session, session_case.id), session_case.camera_from_station_seed, {});
  const auto camera_from_station = solved.camera_from_station();
  if (!camera_from_station)
    throw InputError(
        "session", "cases",
        "case '" + session_case.id +
            "' has no pose: no run converged, and the annotations fail: " + solved.result.reason);
  pose.source = PoseSource::kAnnotation;
  pose.camera_from_station = *camera_from_station;
}

/// Takes the decided pose; InputError when its source gives another one.
void takeDecision(const Decision& decision, HandedPose& pose) {
  const Pose pose_of_source = pose.camera_from_station;
  static_cast<JudgedPose&>(pose) = *decision.pose;
  requireAsMeasured(pose.case_id, poseDifference(pose, pose_of_source));
  pose.score = 1.0;
  pose.checks = decision.checks;
}

constexpr double kFigureTolerance = 1e-6;  ///< of its size; the last bits are the machine's
constexpr double kFigureRest = 1e-12;      ///< in any unit of a check

LocalizationTrace runAgain(const RunRecord& run, const Session& session,
                           const std::filesystem::path& session_file) {
  LocalizationTrace again = repeatRun(run, session, session_file);
  const std::string place = "run " + run.digest;
  if (again.digest != run.digest)
    throw InputError(
        session_file, place,
        "has another digest when repeated: " + again.digest +
            (run.version == kVersion ? ""
                                     : "; it is from version " + run.version + ", this is " +
                                           kVersion + ": run and decide again"));
  if (localizationStatusText(again.status) != run.status)
    throw InputError(session_file, place,
                     std::string("ended as ") + localizationStatusText(again.status) +
                         ", not as stated: " + run.status);
  return again;
}

bool near(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::abs(*a - *b) <= kFigureTolerance * std::max(std::abs(*a), std::abs(*b)) + kFigureRest;
}

/// By data alone: titles and sentences are worded by the version that decided.
bool sameCheck(const Check& stated, const Check& measured) {
  return stated.id == measured.id && stated.state == measured.state &&
         stated.unit == measured.unit && (!measured.limit || stated.side == measured.side) &&
         near(stated.figure, measured.figure) && near(stated.limit, measured.limit);
}

std::string shortText(const Check& check) {
  const std::string figure = figureText(check);
  return checkStateText(check.state) + (figure.empty() ? "" : ", " + figure);
}

std::string differenceText(const Check& stated, const Check& measured) {
  const std::string before = shortText(stated);
  const std::string after = shortText(measured);
  return "'" + measured.title + "' is stated as " + before + " and measured as " + after +
         (before == after ? ", with other digits" : "");
}

const Check* findStated(const HandedPose& stated, const std::string& id) {
  const auto found = std::ranges::find(
      stated.checks, id,
      [](const JudgedCheck& judged) -> const std::string& { return judged.check.id; });
  return found == stated.checks.end() ? nullptr : &found->check;
}

/// A run that had other options than the session has now names them, so that it can be repeated.
/// One that did not converge has no pose and is not repeated.
Session withPlans(Session session) {
  for (RunRecord& run : session.runs) {
    if (!converged(&run)) continue;
    const SessionCase& session_case = *session.findCase(run.case_id);
    if (!run.rerun &&
        run.options_sha256 != optionsDigest(caseOptions(session, session_case, "session")))
      run.rerun = RerunRecord{loadRun(run).plan(), ""};
  }
  return session;
}

}  // namespace

HandedPose handedPose(const Session& session, const std::string& case_id) {
  const SessionCase& session_case = knownCase(session, case_id);
  HandedPose pose;
  pose.case_id = case_id;
  const ReviewStatus status = reviewStatusOf(session, case_id);
  pose.validated = status.state == ReviewState::kValidated;
  pose.review_status = reviewStatusText(status);
  const RunRecord* run = session.lastRunOf(case_id);
  const Decision* decision = status.judgedPose();
  const bool of_run =
      decision != nullptr ? decision->pose->source == PoseSource::kRun : converged(run);
  if (of_run && !converged(run))
    throw InputError(
        "session", "decisions",
        "the decision on case '" + case_id + "' belongs to a run that did not converge");
  if (of_run)
    takeRun(currentRunOf(session, case_id), pose);
  else
    takeAnnotations(session, session_case, pose);
  if (decision != nullptr) takeDecision(*decision, pose);
  return pose;
}

HandedPoses handedPoses(const Session& session, const std::vector<std::string>& case_ids,
                        const std::function<void(int done, int of)>& progress) {
  for (const std::string& id : case_ids) (void)knownCase(session, id);
  HandedPoses handed;
  int done = 0;
  for (const auto& session_case : session.cases) {
    if (progress) progress(done++, static_cast<int>(session.cases.size()));
    if (!case_ids.empty() && std::ranges::find(case_ids, session_case->id) == case_ids.end())
      continue;
    try {
      handed.poses.push_back(handedPose(session, session_case->id));
    } catch (const InputError& error) {
      handed.notes.push_back(error.what());
    }
  }
  return handed;
}

CheckedPose checkedPose(const Session& session, const std::string& case_id) {
  CheckedPose checked;
  checked.pose = handedPose(session, case_id);
  checked.session = withPlans(sessionOfCase(session, case_id, checked.pose.run_digest));
  const ReviewStatus status = reviewStatusOf(checked.session, case_id);
  checked.pose.review_status = reviewStatusText(status);  // of what is handed over
  const Decision* decision = status.judgedPose();
  const int convergence_seeds = decision != nullptr ? decision->convergence_seeds : 0;
  MeasuredPose measured = measurePose(checked.session, checked.pose, convergence_seeds, "session");
  if (decision == nullptr) {
    checked.pose.covariance = measured.subject.covariance;
    for (const Check& check : measured.checks) checked.pose.checks.push_back({check, ""});
  }
  requireAsMeasured(case_id, poseDifference(checked.pose, measured.subject.camera_from_station));
  requireAsMeasured(case_id, covarianceDifference(checked.pose, measured.subject.covariance));
  requireAsMeasured(case_id, checksDifference(checked.pose, measured.checks, true));
  checked.subject = std::move(measured.subject);
  return checked;
}

Session sessionOfCase(const Session& session, const std::string& case_id,
                      const std::string& run_digest) {
  const std::vector<std::string> linked = casesOfRig(session, case_id);
  const auto isOther = [&](const std::string& id) {
    return id != case_id && std::ranges::find(linked, id) == linked.end();
  };
  const Decision* decision = session.decisionOn(case_id);
  const RunRecord* last = session.lastRunOf(case_id);
  // Whatever the pose is from: a decision on a run holds while it is the last one, and one on a
  // case without a pose while it has no run.
  const bool needs_last =
      last != nullptr && decision != nullptr && (!decision->digest.empty() || !decision->pose);
  Session next = session;
  next.cases.eraseIf([&](const auto& item) { return isOther(item->id); });
  next.annotations.eraseIf([&](const auto& entry) { return isOther(entry.first); });
  next.runs.eraseIf([&](const RunRecord& run) {
    if (isOther(run.case_id)) return true;
    if (run.case_id == case_id)
      return run.digest != run_digest && !(needs_last && run.digest == last->digest);
    const RunRecord* asked = ownRunOf(session, run.case_id, case_id);
    return asked == nullptr || run != *asked;
  });
  next.decisions.clear();
  if (decision != nullptr) next.decisions.push_back(*decision);
  if (!next.decisions.empty() && reviewStatusOf(session, case_id).judgedPose() == nullptr)
    next.decisions.front().checks.clear();
  next.rounds.clear();
  next.view = {};
  return next;
}

MeasuredPose measurePose(const Session& session, const HandedPose& pose, int convergence_seeds,
                         const std::filesystem::path& session_file) {
  const auto read_run = [&](const RunRecord& run) { return runAgain(run, session, session_file); };
  MeasuredPose measured;
  measured.subject = reviewSubject(session, loadCase(*session.findCase(pose.case_id)), pose.source,
                                   pose.run_digest, read_run);
  const CheckLimits limits = checkLimits(session.review.preset, session.review.limits);
  measured.checks =
      checkPose(measured.subject, limits, convergenceTest(measured.subject, convergence_seeds));
  return measured;
}

std::string poseDifference(const HandedPose& stated, const Pose& measured) {
  const Vector6d apart = perturbationBetween(stated.camera_from_station, measured);
  // A quaternion and its negative are one rotation, so the numbers themselves are not compared.
  const double limit = stated.source == PoseSource::kRun ? 1e-15 : 1e-9;
  const double rotation_rad = apart.head<3>().norm();
  const double translation_m = apart.tail<3>().norm();
  if (rotation_rad <= limit && translation_m <= limit) return "";
  return "the pose differs: " + numberText(translation_m * 1e3) + " mm and " +
         numberText(rotation_rad * 1e3) + " mrad from the stated pose";
}

std::string covarianceDifference(const HandedPose& stated, const PoseCovariance& measured) {
  const double tolerance = stated.source == PoseSource::kRun ? 1e-12 : kFigureTolerance;
  const auto differs = [&](const Matrix6d& a, const Matrix6d& b) {
    const Vector6d sigma = b.diagonal().cwiseMax(0.0).cwiseSqrt();
    const Matrix6d allowed = tolerance * sigma * sigma.transpose();
    return !((a - b).cwiseAbs().array() <= allowed.array()).all();
  };
  if (!differs(stated.covariance.picture, measured.picture) &&
      !differs(stated.covariance.mesh_scale, measured.mesh_scale) &&
      !differs(stated.covariance.calibration, measured.calibration))
    return "";
  const auto translation_mm = [](const Matrix6d& covariance) {
    return numberText(1e3 * std::sqrt(std::max(0.0, covariance.bottomRightCorner<3, 3>().trace())));
  };
  return "the covariance differs: the translation has a sigma of " +
         translation_mm(measured.total()) + " mm, stated are " +
         translation_mm(stated.covariance.total()) + " mm";
}

std::string checksDifference(const HandedPose& stated, const std::vector<Check>& measured,
                             bool with_convergence) {
  if (stated.checks.size() != measured.size())
    return std::to_string(stated.checks.size()) + " checks are stated, but " +
           std::to_string(measured.size()) + " are measured";
  std::string text;
  for (const Check& check : measured) {
    const Check* found = findStated(stated, check.id);
    const bool compared = with_convergence || !isConvergenceCheck(check.id);
    if (found != nullptr && (!compared || sameCheck(*found, check))) continue;
    text +=
        (text.empty() ? "check " : "; ") +
        (found == nullptr ? "'" + check.title + "' is not stated" : differenceText(*found, check));
  }
  return text;
}

std::vector<std::string> rewordedChecks(const HandedPose& stated,
                                        const std::vector<Check>& measured, bool with_convergence) {
  std::vector<std::string> titles;
  for (const Check& check : measured)
    if (const Check* found = findStated(stated, check.id);
        found != nullptr && (with_convergence || !isConvergenceCheck(check.id)) &&
        (found->title != check.title || found->sentence != check.sentence))
      titles.push_back(check.title);
  return titles;
}

void requireAsMeasured(const std::string& case_id, const std::string& difference) {
  if (!difference.empty())
    throw InputError("session", "case " + case_id,
                     difference + "; run and decide again, or restore the session");
}

}  // namespace boresight::sessions
