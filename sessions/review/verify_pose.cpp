// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/verify_pose.h"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_document.h"
#include "sessions/io/json_writer.h"
#include "sessions/review/decide.h"
#include "sessions/review/standing.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/case_marks.h"
#include "sessions/session/case_run.h"
#include "sessions/session/decision_json.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_json.h"
#include "sessions/session/views_run.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The document with what was read of it.
struct Document {
  fs::path file;
  ordered_json json;
  Session session;
  HandedPose pose;
};

Pose readPlainPose(const JsonReader& pose) {
  const auto q = pose.at("camera_from_station_quaternion_wxyz").elements(4);
  Pose read;
  read.rotation = Eigen::Quaterniond(q[0].number(), q[1].number(), q[2].number(), q[3].number());
  if (!(std::abs(read.rotation.squaredNorm() - 1.0) <= 1e-9))
    pose.failMember("camera_from_station_quaternion_wxyz", "not a unit quaternion");
  read.translation_m = pose.at("camera_from_station").matrix4().topRightCorner<3, 1>();
  return read;
}

HandedPose readHandedPose(const JsonReader& root) {
  HandedPose handed;
  const JsonReader pose = root.at("pose");
  handed.case_id = root.at("case").text();
  handed.source = pose.at("source").choice({"run", "annotation"}) == "run"
                      ? PoseSource::kRun
                      : PoseSource::kAnnotation;
  handed.camera_from_station = readPlainPose(pose);
  if (const auto terms = pose.find("covariance_terms"))
    handed.covariance = readPoseCovariance(*terms);
  for (const JsonReader& check : root.at("checks").elements())
    handed.checks.push_back(readJudgedCheck(check));
  return handed;
}

Document readDocument(const fs::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  const JsonDocument strict(file, asText(bytes));
  const JsonReader root = strict.root(kValidatedPoseFormat, kValidatedPoseVersion);
  Document document;
  document.file = file;
  document.json = ordered_json::parse(asText(bytes));  // keeps the order, which is signed
  document.session = readSession(root.at("session"));
  document.pose = readHandedPose(root);
  if (document.session.findCase(document.pose.case_id) == nullptr)
    root.failMember("case", "the session inside does not have it");
  return document;
}

/// Collects what is found.
class Findings {
 public:
  explicit Findings(VerifyReport& report) : report_(&report) {}
  void add(bool good, const std::string& what, const std::string& text) {
    report_->findings.push_back({good, what, text});
  }

 private:
  VerifyReport* report_;
};

void verifySignature(const Document& document, Findings& findings) {
  const auto stated = document.json.find("signature");
  const bool good = stated != document.json.end() && *stated == signatureOf(document.json);
  findings.add(good, "signature",
               good ? "the document is as it was signed"
                    : "the document has been changed since it was signed, or was never signed");
}

/// True when all files are what they were.
bool verifyInputs(const Document& document, Findings& findings) {
  bool all = true;
  for (const Finding& found : checkInputs(document.session)) {
    if (found.what == "run") continue;  // a run's trace does not come along: it is run again
    findings.add(false, found.what, found.text);
    all = false;
  }
  if (all) findings.add(true, "inputs", "every file that it names has the hash that it names");
  return all;
}

/// Whether the decision inside is one that this program would have let pass.
void verifyDecision(const Standing& standing, Findings& findings) {
  if (standing.decision == nullptr) {
    findings.add(true, "decision", "nobody has decided on it");
    return;
  }
  const Decision& decision = *standing.decision;
  std::string wrong = standing.dropped.empty() ? "" : "it no longer holds: " + standing.dropped;
  for (const JudgedCheck& judged : decision.checks)
    if (decision.verdict == Verdict::kValidated && judged.check.state == CheckState::kFailed &&
        judged.override_reason.empty())
      wrong = "the check '" + judged.check.title + "' failed and was not passed over";
  if (decision.verdict == Verdict::kValidated && decision.checks.empty())
    wrong = "no check was made of it";
  if (decision.approval && samePerson(decision.approval->by, decision.by))
    wrong = decision.by + " approved what the same person had validated";
  findings.add(wrong.empty(), "decision",
               wrong.empty() ? "the decision could be made, and holds" : wrong);
}

/// Nothing when it cannot be run.
std::optional<LocalizationTrace> runAgain(const Document& document, Findings& findings) {
  const RunRecord* run = document.session.lastRunOf(document.pose.case_id);
  if (run == nullptr) {
    findings.add(false, "run", "the document does not say which run its pose is of");
    return {};
  }
  LocalizationTrace trace = repeatRun(*run, document.session, document.file);
  const bool same = trace.digest == run->digest;
  const std::string together =
      run->together ? " " + togetherText(run->together->views, run->case_id) : "";
  std::string text = same ? "the run" + together + " gives the same digest again"
                          : "the run" + together + " gives another digest: " + trace.digest +
                                " instead of " + run->digest;
  if (!same && run->version != kVersion)
    text += "; it was made by version " + run->version + ", this is " + kVersion;
  findings.add(same, "run", text);
  return trace;
}

void comparePoses(const Document& document, const Pose& computed, Findings& findings) {
  const Vector6d apart = perturbationBetween(document.pose.camera_from_station, computed);
  // A quaternion and its negative are one rotation; of marks the last bits are the machine's.
  const double limit = document.pose.source == PoseSource::kRun ? 1e-15 : 1e-9;
  const bool same = apart.head<3>().norm() <= limit && apart.tail<3>().norm() <= limit;
  findings.add(same, "pose",
               same ? "it is the pose that comes out again"
                    : "another pose comes out: " + numberText(apart.tail<3>().norm() * 1e3) +
                          " mm and " + numberText(apart.head<3>().norm() * 1e3) +
                          " mrad from the one stated");
}

void solveAgain(const Document& document, Findings& findings) {
  const SessionCase& one = *document.session.findCase(document.pose.case_id);
  const CaseMarksSolution solved =
      solveCaseMarks(caseMarks(document.session, one.id), marksGuess(one), {}, false);
  if (const auto pose = solved.camera_from_station())
    comparePoses(document, *pose, findings);
  else
    findings.add(false, "pose", "its marks give no pose: " + solved.result.reason);
}

/// Everything that follows from the session inside and the pose must be what is stated.
void verifyMembers(const Document& document, const std::optional<LocalizationTrace>& trace,
                   Findings& findings) {
  const ordered_json anew = ordered_json::parse(
      prettyJson(validatedPoseJson(document.session, document.pose, trace, document.file)));
  std::string wrong;
  for (const auto& [name, value] : anew.items()) {
    if (name == "written" || name == "signature") continue;
    if (!document.json.contains(name) || document.json[name] != value)
      wrong += (wrong.empty() ? "" : ", ") + name;
  }
  for (const auto& [name, value] : document.json.items())
    if (!anew.contains(name) && name != "run") wrong += (wrong.empty() ? "" : ", ") + name;
  findings.add(wrong.empty(), "contents",
               wrong.empty() ? "poses, chain, checks and hashes follow from each other"
                             : "these members do not follow from the rest: " + wrong);
}

/// What the session inside says of the pose; the document's own where nobody decided.
void takeStanding(Document& document, const Standing& standing) {
  HandedPose& pose = document.pose;
  pose.validated = standing.state == CaseStanding::kValidated;
  pose.standing = standingText(standing);
  if (const RunRecord* run = document.session.lastRunOf(pose.case_id);
      run != nullptr && pose.source == PoseSource::kRun)
    pose.run_digest = run->digest;
  if (!standing.holds() || !standing.decision->pose) return;
  pose.source = standing.decision->pose->source;
  pose.camera_from_station = standing.decision->pose->camera_from_station;
  pose.covariance = standing.decision->pose->covariance;
  pose.checks = standing.decision->checks;
}

}  // namespace

bool VerifyReport::good() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const VerifyFinding& one) { return one.good; });
}

VerifyReport verifyPose(const fs::path& file, bool run_again) {
  Document document = readDocument(file);
  VerifyReport report;
  Findings findings(report);
  verifySignature(document, findings);
  const Standing standing = standingOf(document.session, document.pose.case_id);
  takeStanding(document, standing);
  report.standing = document.pose.standing;
  const bool inputs = verifyInputs(document, findings);
  verifyDecision(standing, findings);
  std::optional<LocalizationTrace> trace;
  if (run_again && inputs && document.pose.source == PoseSource::kRun) {
    try {
      trace = runAgain(document, findings);
    } catch (const InputError& error) {
      findings.add(false, "run", std::string("it cannot be run again: ") + error.what());
    }
    if (trace) comparePoses(document, trace->camera_from_station, findings);
    if (!document.json.contains("run")) trace.reset();  // it was written without its matches
  } else if (run_again && document.pose.source == PoseSource::kAnnotation) {
    solveAgain(document, findings);
  }
  verifyMembers(document, trace, findings);
  return report;
}

}  // namespace boresight::sessions
