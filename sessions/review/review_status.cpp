// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/review_status.h"

#include <algorithm>
#include <set>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/annotation/annotations_file.h"
#include "sessions/decision/decision.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/case_dependencies.h"
#include "sessions/session/rig_links.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

ReviewState undecided(const Session& session, const std::string& case_id) {
  if (const RunRecord* run = session.lastRunOf(case_id))
    return run->status == "converged" ? ReviewState::kConverged : ReviewState::kFailed;
  return session.annotations.count(case_id) > 0 ? ReviewState::kAnnotated : ReviewState::kNew;
}

/// Why a decision no longer holds, or "".
std::string droppedText(const Session& session, const Decision& decision) {
  if (decision.input_fingerprint.empty() ||
      (decision.verdict == Verdict::kValidated && !decision.pose))
    return "it does not state its inputs";
  const bool of_run = !decision.digest.empty();
  const RunRecord* last = session.lastRunOf(decision.case_id);
  if (!of_run && !decision.pose && last != nullptr) return "there is a later run";
  if (of_run && last == nullptr) return "its run is missing";
  if (of_run && last->digest != decision.digest) return "there is a later run";
  return changedInputsText(decision.input_fingerprint,
                           inputFingerprint(session, decision.case_id, decision.digest));
}

/// The options are no part of the fingerprint: the pose stays validated as the run found it.
std::string outdatedText(const Session& session, const Decision& decision) {
  const RunRecord* run = findRun(session, decision.case_id, decision.digest);
  const SessionCase* session_case = session.findCase(decision.case_id);
  if (decision.digest.empty() || run == nullptr || session_case == nullptr) return "";
  const bool same =
      run->options_sha256 == optionsDigest(caseOptions(session, *session_case, "session"));
  return same ? "" : "the run was made with other options";
}

std::string byText(const Decision& decision) {
  std::string text = " by " + decision.by;
  if (decision.approval) text += ", approved by " + decision.approval->by;
  return text;
}

std::string sha256Of(const ordered_json& json) { return sha256Text(json.dump()); }

ordered_json annotationsJson(const Session& session, const std::string& case_id) {
  std::vector<std::string> ids = casesOfRig(session, case_id);
  ids.insert(ids.begin(), case_id);
  ordered_json json = ordered_json::object();
  for (const std::string& id : ids)
    if (const auto found = session.annotations.find(id); found != session.annotations.end())
      json[id] = toJson(*found->second);
  if (session.robust_annotations && !json.empty()) json["robust"] = true;
  return json;
}

/// The rig's cameras as they lie to each other, and what their runs depend on; its name is only a
/// name.
ordered_json rigJson(const Session& session, const SessionCase& session_case) {
  ordered_json json = ordered_json::object();
  if (!session_case.rig) return json;
  json[session_case.id] = exactPoseJson(session_case.rig->camera_from_rig);
  for (const std::string& id : casesOfRig(session, session_case.id)) {
    const SessionCase& other = *session.findCase(id);
    auto depends = dependencyDigests(other);
    json[id] = {{"camera_from_rig", exactPoseJson(other.rig->camera_from_rig)},
                {"inputs", depends["inputs"]},
                {"image", depends["image"]},
                {"input_sigmas", depends["input_sigmas"]}};
  }
  return json;
}

/// The runs that the check against the rig's other cameras asks.
ordered_json otherRunsJson(const Session& session, const std::string& case_id) {
  ordered_json json = ordered_json::object();
  for (const std::string& id : casesOfRig(session, case_id))
    if (const RunRecord* run = ownRunOf(session, id, case_id)) json[id] = run->digest;
  return json;
}

const char* inputText(const std::string& name) {
  static const std::map<std::string, const char*> kTexts = {
      {"inputs", "the image, camera, mesh, seed or mask"},
      {"image", "the image's file"},
      {"image_label", "the image's label"},
      {"names", "the name of case or station"},
      {"frames", "the frames"},
      {"run", "the run"},
      {"annotations", "the annotations"},
      {"truth", "the truth"},
      {"input_sigmas", "the stated sigmas of mesh and camera"},
      {"requirement", "the requirement or the symmetries"},
      {"end_effector", "the end effector"},
      {"rig", "the rig"},
      {"other_runs", "the runs of the rig's other cameras"},
      {"onboard_record", "the onboard record"},
      {"limits", "the limits of the checks"},
      {"others", "other data of the case"}};
  const auto found = kTexts.find(name);
  return found == kTexts.end() ? name.c_str() : found->second;
}

bool isPlural(const std::string& text) {
  return text.starts_with("the annotations") || text.starts_with("the frames") ||
         text.starts_with("the limits") || text.starts_with("the runs") ||
         text.starts_with("the stated sigmas");
}

/// A name of which nothing is a letter is compared as it is.
std::string comparableName(const std::string& name) {
  const std::string letters = lettersOf(name);
  return letters.empty() ? name : letters;
}

Signature requireSigned(const Signature& who, const char* what) {
  const Signature plain{trimmedVisible(who.by), trimmedVisible(who.comment)};
  if (plain.by.empty()) throw DecisionError("give your name");
  if (plain.comment.empty())
    throw DecisionError(std::string("give a comment: why do you ") + what + "?");
  return plain;
}

void requireCase(const Session& session, const std::string& case_id) {
  if (session.findCase(case_id) == nullptr)
    throw DecisionError("there is no case '" + case_id + "'");
}

/// Pairs each check with the reason to waive it.
std::vector<JudgedCheck> judgedChecks(const std::vector<Check>& checks,
                                      const CheckWaivers& waivers) {
  std::vector<JudgedCheck> judged;
  for (const Check& check : checks) {
    const auto found = waivers.find(check.id);
    const bool waived = check.state == CheckState::kFailed && found != waivers.end();
    judged.push_back({check, waived ? trimmedVisible(found->second) : ""});
  }
  return judged;
}

void requireAnswered(const std::vector<JudgedCheck>& checks) {
  bool checked = false;
  std::vector<std::string> open;
  for (const auto& [check, waiver_reason] : checks) {
    checked |= check.state != CheckState::kNotApplicable;
    if (check.state == CheckState::kFailed && waiver_reason.empty()) open.push_back(check.title);
  }
  if (!checked) throw DecisionError("this pose has not been checked");
  if (!open.empty()) throw DecisionError("failed checks are not waived: " + joined(open));
}

/// DecisionError for a waiver of a check that does not exist or has not failed.
void requireKnownWaivers(const std::vector<Check>& checks, const CheckWaivers& waivers) {
  for (const auto& [id, reason] : waivers) {
    const auto found = std::ranges::find(checks, id, &Check::id);
    if (found == checks.end()) throw DecisionError("there is no check '" + id + "'");
    if (found->state != CheckState::kFailed)
      throw DecisionError("the check '" + found->title + "' has not failed and needs no waiver");
    if (trimmed(reason).empty())
      throw DecisionError("give a reason to waive '" + found->title + "'");
  }
}

Decision newDecision(const std::string& case_id, Verdict verdict, const Signature& who) {
  return {.case_id = case_id,
          .verdict = verdict,
          .by = who.by,
          .comment = who.comment,
          .time = utcNowText(),
          .digest = {}};
}

Session withDecision(const Session& session, Decision decision) {
  Session next = session;
  next.decisions.push_back(std::move(decision));
  return next;
}

}  // namespace

const char* reviewStateText(ReviewState state) {
  constexpr const char* kTexts[] = {"new",       "converged", "failed",
                                    "annotated", "validated", "rejected"};
  return kTexts[static_cast<std::size_t>(state)];
}

ReviewStatus reviewStatusOf(const Session& session, const std::string& case_id) {
  ReviewStatus status;
  status.state = undecided(session, case_id);
  const Decision* decision = session.decisionOn(case_id);
  if (decision == nullptr || decision->verdict == Verdict::kReopened) return status;
  status.decision = decision;
  status.dropped = droppedText(session, *decision);
  if (!status.holds()) return status;
  if (decision->verdict == Verdict::kRejected) {
    status.state = ReviewState::kRejected;
    return status;
  }
  status.outdated = outdatedText(session, *decision);
  if (session.review.second_person && !decision->approval)
    status.awaits_approval = true;
  else
    status.state = ReviewState::kValidated;
  return status;
}

std::string reviewStatusText(const ReviewStatus& status) {
  const std::string outdated = status.outdated.empty() ? "" : "; outdated: " + status.outdated;
  if (status.state == ReviewState::kValidated)
    return "validated" + byText(*status.decision) + outdated;
  if (status.state == ReviewState::kRejected)
    return "NOT VALIDATED: rejected" + byText(*status.decision);
  const std::string text = std::string("NOT VALIDATED: ") + reviewStateText(status.state);
  if (status.awaits_approval)
    return text + "; validated" + byText(*status.decision) + ", a second person must approve" +
           outdated;
  if (status.decision == nullptr) return text;
  const char* what = status.decision->verdict == Verdict::kValidated ? "validation" : "rejection";
  return text + "; the " + what + byText(*status.decision) + " no longer holds: " + status.dropped;
}

std::map<std::string, std::string> inputFingerprint(const Session& session,
                                                    const std::string& case_id,
                                                    const std::string& run_digest) {
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr) return {};
  std::map<std::string, std::string> fingerprint = dependencyDigests(*session_case);
  fingerprint["annotations"] = sha256Of(annotationsJson(session, case_id));
  fingerprint["rig"] = sha256Of(rigJson(session, *session_case));
  fingerprint["other_runs"] = sha256Of(otherRunsJson(session, case_id));
  ReviewSettings limits = session.review;
  limits.second_person = false;  // who has to sign does not change what was measured
  fingerprint["limits"] = sha256Of(toJson(limits));
  if (!run_digest.empty()) fingerprint["run"] = sha256Text(run_digest);
  return fingerprint;
}

std::string changedInputsText(const std::map<std::string, std::string>& before,
                              const std::map<std::string, std::string>& after) {
  std::vector<std::string> changed, not_recorded;
  for (const auto& [name, sha256] : after) {
    const auto found = before.find(name);
    if (found == before.end())
      not_recorded.emplace_back(inputText(name));
    else if (found->second != sha256)
      changed.emplace_back(inputText(name));
  }
  for (const auto& [name, sha256] : before)
    if (!after.contains(name)) changed.emplace_back(inputText(name));
  if (!not_recorded.empty())
    return "an earlier version made it and did not record " + listText(not_recorded) +
           ": decide again";
  if (changed.empty()) return "";
  const bool one_thing = changed.size() == 1 && !isPlural(changed.front());
  return listText(changed) + (one_thing ? " has changed" : " have changed");
}

bool samePerson(const std::string& text, const std::string& other) {
  return comparableName(text) == comparableName(other);
}

std::string validationConcern(const Session& session, const ReviewSubject& subject) {
  const std::string& id = subject.loaded->source.id;
  const SessionCase* session_case = session.findCase(id);
  if (session_case == nullptr) return "there is no case '" + id + "' any more";
  if (inputsDigest(*session_case) != inputsDigest(subject.loaded->source))
    return "the inputs have changed since they were checked: check again";
  if (subject.source == PoseSource::kAnnotation) return "";
  if (!subject.run || subject.run->digest.empty()) return "there is no finished run";
  if (!subject.run->converged())
    return "the run did not converge, so that no pose can be validated; annotate the image, or run "
           "with other options";
  const RunRecord* last = session.lastRunOf(id);
  if (last == nullptr || last->digest != subject.run->digest)
    return "this is not the last run of the case; review the last run, or run again";
  if (inputsChangedSince(*last, session)) return "the inputs have changed since the run: run again";
  return "";
}

Session validated(const Session& session, const ReviewSubject& subject,
                  const std::vector<Check>& checks, const CheckWaivers& waivers,
                  const Signature& who, int convergence_seeds) {
  const Signature signature = requireSigned(who, "validate this pose");
  const std::string concern = validationConcern(session, subject);
  if (!concern.empty()) throw DecisionError(concern);
  requireKnownWaivers(checks, waivers);
  const std::string& id = subject.loaded->source.id;
  Decision decision = newDecision(id, Verdict::kValidated, signature);
  decision.checks = judgedChecks(checks, waivers);
  decision.convergence_seeds = convergence_seeds;
  requireAnswered(decision.checks);
  if (subject.run) decision.digest = subject.run->digest;
  decision.pose = subject;
  decision.input_fingerprint = inputFingerprint(session, id, decision.digest);
  return withDecision(session, std::move(decision));
}

std::string lastRunDigest(const Session& session, const std::string& case_id) {
  const RunRecord* run = session.lastRunOf(case_id);
  return run != nullptr ? run->digest : std::string();
}

Session approved(const Session& session, const std::string& case_id, const std::string& seen_run,
                 const Signature& who) {
  requireCase(session, case_id);
  const Signature signature = requireSigned(who, "approve this validation");
  const ReviewStatus status = reviewStatusOf(session, case_id);
  if (status.decision == nullptr || status.decision->verdict != Verdict::kValidated)
    throw DecisionError("there is no validation of '" + case_id + "' to approve");
  if (!status.holds()) throw DecisionError("the validation no longer holds: " + status.dropped);
  // Of annotations, no run needs to be seen.
  if (!status.decision->digest.empty() && status.decision->digest != seen_run)
    throw DecisionError("the validation is of another run than the shown one");
  if (status.decision->approval)
    throw DecisionError("it is already approved by " + status.decision->approval->by);
  if (samePerson(status.decision->by, signature.by))
    throw DecisionError(signature.by + " validated it; another person must approve");
  Decision decision = *status.decision;
  decision.approval = Approval{signature.by, signature.comment, utcNowText()};
  return withDecision(session, std::move(decision));
}

Session rejected(const Session& session, const std::string& case_id, const std::string& seen_run,
                 const std::vector<Check>& checks, const Signature& who) {
  requireCase(session, case_id);
  if (seen_run != lastRunDigest(session, case_id))
    throw DecisionError("the shown run is not the last run of '" + case_id + "'");
  Decision decision =
      newDecision(case_id, Verdict::kRejected, requireSigned(who, "reject this result"));
  decision.checks = judgedChecks(checks, {});
  decision.digest = seen_run;
  decision.input_fingerprint = inputFingerprint(session, case_id, decision.digest);
  return withDecision(session, std::move(decision));
}

Session reopened(const Session& session, const std::string& case_id, const Signature& who) {
  requireCase(session, case_id);
  const Decision* last = session.decisionOn(case_id);
  if (last == nullptr || last->verdict == Verdict::kReopened)
    throw DecisionError("there is no decision on '" + case_id + "' to take back");
  return withDecision(session, newDecision(case_id, Verdict::kReopened,
                                           requireSigned(who, "withdraw this decision")));
}

}  // namespace boresight::sessions
