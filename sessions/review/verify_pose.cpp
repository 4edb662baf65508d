// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/decision/decision.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/review/key_signature.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_file.h"
#include "sessions/text/plain_text.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The document with what was read of it.
struct Document {
  fs::path file;
  ordered_json json;
  Session session;  ///< as embedded
  Session located;  ///< the same with the paths that its files have here
  HandedPose pose;
};

Pose readPlainPose(const JsonReader& pose) {
  const auto q = pose.at("camera_from_station_quaternion_wxyz").elements(4);
  Pose read;
  read.rotation = Eigen::Quaterniond(q[0].number(), q[1].number(), q[2].number(), q[3].number());
  if (!(std::abs(read.rotation.squaredNorm() - 1.0) <= 1e-9))
    pose.failMember("camera_from_station_quaternion_wxyz", "not a unit quaternion");
  read.translation_m = pose.at("camera_from_station").matrix<4>().topRightCorner<3, 1>();
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
  const std::string_view text = textOf(file, asText(bytes));
  const JsonDocument strict(file, text);
  const JsonReader root = strict.root();
  root.requireFormat(kValidatedPoseFormat, kValidatedPoseVersion);
  Document document;
  document.file = file;
  document.json = ordered_json::parse(text);  // keeps the order, as the checksum does
  document.session = document.located = readSession(root.at("session"));
  document.pose = readHandedPose(root);
  if (document.session.findCase(document.pose.case_id) == nullptr)
    root.failMember("case", "the embedded session does not have it");
  return document;
}

using Findings = std::vector<VerifyFinding>;

/// Adds a finding: `good`, or `wrong` unless that is empty.
void note(Findings& findings, const char* what, const std::string& wrong, const std::string& good) {
  findings.push_back({wrong.empty(), what, wrong.empty() ? good : wrong});
}

/// Of a file by version 1.0 the member has its former name.
std::string checksumMember(const Document& document) {
  return document.json.contains(kChecksumMember) ? kChecksumMember : kFormerChecksumMember;
}

void verifyChecksum(const Document& document, Findings& findings) {
  const std::string member = checksumMember(document);
  const auto stated = document.json.find(member);
  const bool good = stated != document.json.end() && *stated == checksumOf(document.json, member);
  note(findings, "checksum", good ? "" : "the document was changed since it was written",
       "the document is unchanged since it was written");
}

/// Whether the deciders signed the file with their own keys.
void verifyKeys(const Document& document, const fs::path& signers, Findings& findings) {
  const Decision* decision = document.session.decisionOn(document.pose.case_id);
  if (decision == nullptr)
    return note(findings, "key", "there is no decision that a key could have signed", "");
  std::vector<std::string> names = {decision->by};
  if (decision->approval) names.push_back(decision->approval->by);
  for (const std::string& name : names) {
    const bool good = isSignedBy(name, document.file, signers);
    note(findings, "key",
         good ? ""
              : "no signature of " + name + " with a key that " + signers.filename().string() +
                    " lists for this name",
         name + " signed the file");
  }
}

/// Why the identifiers of a case's image are not those of its file's label, or "".
std::string labelConcern(const SessionCase& session_case) {
  const fs::path& image = session_case.image.source.file;
  const bool labelled = hasImageLabel(image);
  const auto in_file = labelled ? readImageLabel(image).identifiers : std::vector<LabelItem>();
  return in_file == session_case.image.label
             ? ""
             : "case " + session_case.id + ": the stated label is not that of " + image.string();
}

/// True when all files are what they were.
bool verifyInputs(const Document& document, Findings& findings) {
  bool all = true;
  for (const Finding& found : checkInputs(document.located)) {
    if (found.what == "run") continue;  // a run's trace does not come along: it is run again
    findings.push_back({false, found.what, found.text});
    all = false;
  }
  if (!all) return false;
  for (const auto& session_case : document.located.cases)
    if (const std::string concern = labelConcern(*session_case); !concern.empty()) {
      findings.push_back({false, "image_label", concern});
      all = false;
    }
  if (all) findings.push_back({true, "inputs", "every named file has the stated hash"});
  return all;
}

std::string noLongerHoldsText(const ReviewStatus& status) {
  return "it no longer holds: " + status.dropped;
}

/// Whether the decision no longer holds, and the document states this.
bool statesDropped(const Document& document, const ReviewStatus& status) {
  const auto stated = document.json.find("review_status");
  return !status.dropped.empty() && stated != document.json.end() &&
         *stated == reviewStatusText(status);
}

/// Whether the decision inside is one that this program would have let pass. One that does not hold
/// comes without its checks.
void verifyDecision(const Document& document, const ReviewStatus& status, Findings& findings) {
  if (status.decision == nullptr) return note(findings, "decision", "", "there is no decision");
  if (statesDropped(document, status)) return;  // it is listed as not proved
  if (!status.holds()) return note(findings, "decision", noLongerHoldsText(status), "");
  const Decision& decision = *status.decision;
  std::string wrong;
  for (const JudgedCheck& judged : decision.checks)
    if (decision.verdict == Verdict::kValidated && judged.check.state == CheckState::kFailed &&
        judged.waiver_reason.empty())
      wrong = "the check '" + judged.check.title + "' failed and was not waived";
  if (decision.verdict == Verdict::kValidated && decision.checks.empty())
    wrong = "it has no checks";
  if (decision.approval && samePerson(decision.approval->by, decision.by))
    wrong = decision.by + " both validated and approved";
  note(findings, "decision", wrong, "it follows from the document");
}

void verifyMeasured(const Document& document, const MeasuredPose& measured, bool with_convergence,
                    Findings& findings) {
  if (document.pose.source == PoseSource::kRun) {
    const auto& together = document.session.lastRunOf(document.pose.case_id)->together;
    note(findings, "run", validationConcern(document.session, measured.subject),
         "the run" + (together ? " " + togetherText(together->views, document.pose.case_id) : "") +
             " gives the same digest");
  }
  note(findings, "pose", poseDifference(document.pose, measured.subject.camera_from_station),
       "the measured pose is the same");
  note(findings, "covariance", covarianceDifference(document.pose, measured.subject.covariance),
       "the measured covariance is the same");
  note(findings, "checks", checksDifference(document.pose, measured.checks, with_convergence),
       "measured again, they are the same");
}

/// Nothing when it cannot be measured, which is then found wrong.
std::optional<MeasuredPose> measureAgain(const Document& document, int convergence_seeds,
                                         Findings& findings) {
  try {
    return measurePose(document.located, document.pose, convergence_seeds, document.file);
  } catch (const InputError& error) {
    findings.push_back({false, "run", std::string("it cannot be measured: ") + error.what()});
    return {};
  }
}

/// Everything that follows from the session inside and the pose must be what is stated.
void verifyMembers(const Document& document, const std::optional<MeasuredPose>& measured,
                   Findings& findings) {
  const auto run = measured ? measured->subject.run : std::nullopt;
  const ordered_json remeasured = ordered_json::parse(
      prettyJson(validatedPoseJson(document.session, document.pose, run, document.file)));
  std::vector<std::string> wrong;
  if (!document.json.contains("written")) wrong.push_back("written");
  for (const auto& [name, value] : remeasured.items()) {
    if (name == "written" || name == kChecksumMember) continue;
    if (!document.json.contains(name) || document.json[name] != value) wrong.push_back(name);
  }
  for (const auto& [name, value] : document.json.items())
    if (!remeasured.contains(name) && (measured || name != "run") &&
        name != checksumMember(document))
      wrong.push_back(name);
  note(findings, "contents", wrong.empty() ? "" : "inconsistent members: " + joined(wrong),
       "the members are consistent");
}

/// The run of a pose that has one, and what the document says of it.
void verifyRunStated(const Document& document, Findings& findings) {
  if (document.pose.source != PoseSource::kRun) return;
  if (document.session.lastRunOf(document.pose.case_id) == nullptr)
    findings.push_back({false, "run", "the embedded session does not have the run of the pose"});
  if (!document.json.contains("run"))
    findings.push_back({false, "run", "the member run, with options and matches, is missing"});
}

/// What the session inside says of the pose; the document's own without a decision.
void takeReviewStatus(Document& document, const ReviewStatus& status) {
  HandedPose& pose = document.pose;
  pose.validated = status.state == ReviewState::kValidated;
  pose.review_status = reviewStatusText(status);
  if (const Decision* decision = status.judgedPose()) {
    static_cast<JudgedPose&>(pose) = *decision->pose;
    pose.checks = decision->checks;
  }
  if (const RunRecord* run = document.session.lastRunOf(pose.case_id);
      run != nullptr && pose.source == PoseSource::kRun)
    pose.run_digest = run->digest;
}

/// "by Boresight 1.0.0, 2026-01-31T23:59:59Z".
std::string writtenText(const Document& document) {
  const auto written = document.json.find("written");
  if (written == document.json.end() || !written->is_object()) return "";
  std::string text;
  for (const char* member : {"by", "time"})
    if (const auto found = written->find(member); found != written->end() && found->is_string())
      text += (text.empty() ? "by " : ", ") + found->get<std::string>();
  return text;
}

/// A measurement cannot prove a person, a time, a reason or a wording.
void listNotProved(const Document& document, const std::optional<MeasuredPose>& measured,
                   bool with_convergence, bool with_keys, std::vector<std::string>& list) {
  if (!measured) list.emplace_back("run, pose, covariance and checks: not measured");
  list.push_back("written: " + writtenText(document));
  const auto reworded = measured ? rewordedChecks(document.pose, measured->checks, with_convergence)
                                 : std::vector<std::string>();
  if (!reworded.empty())
    list.push_back("wording: this version words other titles or sentences for " + joined(reworded));
  const ReviewStatus status = reviewStatusOf(document.session, document.pose.case_id);
  const Decision* decision = status.decision;
  if (decision == nullptr) return;
  if (statesDropped(document, status)) list.push_back("decision: " + noLongerHoldsText(status));
  const std::string approved = decision->approval ? " and " + decision->approval->by : "";
  if (!with_keys)
    list.push_back("who: " + decision->by + approved +
                   " (the name is as typed: give --signers to check signatures with their keys)");
  list.push_back("when: " + decision->time +
                 (decision->approval ? " and " + decision->approval->time : ""));
  for (const JudgedCheck& judged : decision->checks)
    if (!judged.waiver_reason.empty())
      list.push_back("reason: why the failed check '" + judged.check.title +
                     "' was waived: " + judged.waiver_reason);
  if (measured && decision->convergence_seeds > 0 && !with_convergence)
    list.push_back("convergence test: its " + std::to_string(decision->convergence_seeds) +
                   " further seeds were not run again (use --full)");
}

}  // namespace

bool VerifyReport::good() const { return std::ranges::all_of(findings, &VerifyFinding::good); }

VerifyReport verifyPose(const fs::path& file, bool run_again, bool convergence_again,
                        const VerifyPlaces& places) {
  Document document = readDocument(file);
  if (places.folder)
    document.located =
        relinked(document.session, findMissing(document.session, *places.folder / file.filename()));
  VerifyReport report;
  Findings& findings = report.findings;
  verifyChecksum(document, findings);
  if (places.signers) verifyKeys(document, *places.signers, findings);
  const ReviewStatus status = reviewStatusOf(document.session, document.pose.case_id);
  takeReviewStatus(document, status);
  report.review_status = document.pose.review_status;
  report.validated = document.pose.validated;
  const bool inputs = verifyInputs(document, findings);
  verifyDecision(document, status, findings);
  verifyRunStated(document, findings);
  const Decision* decision = status.judgedPose();
  const int convergence_seeds =
      convergence_again && decision != nullptr ? decision->convergence_seeds : 0;
  const bool with_convergence =
      convergence_again || decision == nullptr || decision->convergence_seeds == 0;
  std::optional<MeasuredPose> measured;
  if (run_again && inputs) measured = measureAgain(document, convergence_seeds, findings);
  if (measured) verifyMeasured(document, *measured, with_convergence, findings);
  verifyMembers(document, measured, findings);
  listNotProved(document, measured, with_convergence, places.signers.has_value(),
                report.not_proved);
  return report;
}

}  // namespace boresight::sessions
