// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/decide.h"

#include <algorithm>
#include <cctype>

#include "sessions/review/standing.h"

#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

std::string trimmed(const std::string& text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), blank);
  const auto end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), blank).base();
  return {begin, end};
}

/// A name without what people write differently from day to day.
std::string comparableName(const std::string& name) {
  std::string plain;
  for (const char c : name)
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return plain;
}

Signature requireSigned(const Signature& who, const char* what) {
  const Signature plain{trimmed(who.by), trimmed(who.comment)};
  if (plain.by.empty()) throw DecisionError(std::string("give a name: who ") + what + "?");
  if (plain.comment.empty())
    throw DecisionError(std::string("give a comment: on what grounds does ") + plain.by + " " +
                        what + "?");
  return plain;
}

const SessionCase& requireCase(const Session& session, const std::string& case_id) {
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr) throw DecisionError("there is no case '" + case_id + "'");
  return *one;
}

/// Pairs each check with the reason for passing over it.
std::vector<JudgedCheck> judgedChecks(const std::vector<Check>& checks,
                                      const CheckOverrides& overrides) {
  std::vector<JudgedCheck> judged;
  for (const Check& check : checks) {
    const auto found = overrides.find(check.id);
    const bool failed = check.state == CheckState::kFailed;
    judged.push_back({check, failed && found != overrides.end() ? trimmed(found->second) : ""});
  }
  return judged;
}

void requireAnswered(const std::vector<JudgedCheck>& checks) {
  if (std::none_of(checks.begin(), checks.end(), [](const JudgedCheck& one) {
        return one.check.state != CheckState::kNotApplicable;
      }))
    throw DecisionError("no check has been made of this pose");
  std::string open;
  for (const JudgedCheck& one : checks)
    if (one.check.state == CheckState::kFailed && one.override_reason.empty())
      open += (open.empty() ? "" : ", ") + one.check.title;
  if (!open.empty())
    throw DecisionError("these checks failed and have no reason to pass over them: " + open);
}

/// A check without overrides may be given for what is not there any more: it is told.
void requireKnownOverrides(const std::vector<Check>& checks, const CheckOverrides& overrides) {
  for (const auto& [id, reason] : overrides) {
    const auto found = std::find_if(checks.begin(), checks.end(),
                                    [&id = id](const Check& check) { return check.id == id; });
    if (found == checks.end()) throw DecisionError("there is no check '" + id + "'");
    if (found->state != CheckState::kFailed)
      throw DecisionError("the check '" + found->title + "' has not failed: it needs no reason");
    if (trimmed(reason).empty())
      throw DecisionError("give a reason for passing over '" + found->title + "'");
  }
}

Decision newDecision(const std::string& case_id, Verdict verdict, const Signature& who) {
  Decision decision;
  decision.case_id = case_id;
  decision.verdict = verdict;
  decision.by = who.by;
  decision.comment = who.comment;
  decision.time = utcNowText();
  return decision;
}

Session withDecision(const Session& session, Decision decision) {
  Session next = session;
  next.decisions.push_back(std::move(decision));
  return next;
}

}  // namespace

bool samePerson(const std::string& one, const std::string& other) {
  return comparableName(one) == comparableName(other);
}

std::string validationConcern(const Session& session, const ReviewSubject& subject) {
  const std::string& id = subject.loaded->source.id;
  const SessionCase* one = session.findCase(id);
  if (one == nullptr) return "there is no case '" + id + "' any more";
  if (inputsDigest(*one) != inputsDigest(subject.loaded->source))
    return "the inputs have changed since they were checked: check again";
  if (subject.source == PoseSource::kAnnotation) return "";
  if (!subject.run || subject.run->digest.empty()) return "there is no finished run";
  if (!subject.run->converged())
    return "the run did not converge: there is no pose to vouch for; annotate the image, or run "
           "with other options";
  const RunRecord* last = session.lastRunOf(id);
  if (last == nullptr || last->digest != subject.run->digest)
    return "this is not the last run of the case: look at the last one, or run again";
  if (last->inputs_sha256 != inputsDigest(*one))
    return "the run is of other inputs than the case has now: run again";
  return "";
}

Session validated(const Session& session, const ReviewSubject& subject,
                  const std::vector<Check>& checks, const CheckOverrides& overrides,
                  const Signature& who, int basin_seeds) {
  const Signature signature = requireSigned(who, "validates");
  const std::string concern = validationConcern(session, subject);
  if (!concern.empty()) throw DecisionError(concern);
  requireKnownOverrides(checks, overrides);
  const std::string& id = subject.loaded->source.id;
  Decision decision = newDecision(id, Verdict::kValidated, signature);
  decision.checks = judgedChecks(checks, overrides);
  decision.basin_seeds = basin_seeds;
  requireAnswered(decision.checks);
  if (subject.run) decision.digest = subject.run->digest;
  decision.pose = JudgedPose{subject.source, subject.camera_from_station, subject.covariance};
  decision.grounds = judgedGrounds(session, id, decision.digest);
  return withDecision(session, std::move(decision));
}

Session approved(const Session& session, const std::string& case_id, const Signature& who) {
  requireCase(session, case_id);
  const Signature signature = requireSigned(who, "approves");
  const Standing standing = standingOf(session, case_id);
  if (standing.decision == nullptr || standing.decision->verdict != Verdict::kValidated)
    throw DecisionError("there is no validation of '" + case_id + "' to approve");
  if (!standing.holds()) throw DecisionError("the validation no longer holds: " + standing.dropped);
  if (standing.decision->approval)
    throw DecisionError("it has been approved already, by " + standing.decision->approval->by);
  if (samePerson(standing.decision->by, signature.by))
    throw DecisionError(signature.by + " validated it: somebody else has to approve");
  Decision decision = *standing.decision;
  decision.approval = Approval{signature.by, signature.comment, utcNowText()};
  return withDecision(session, std::move(decision));
}

Session rejected(const Session& session, const std::string& case_id,
                 const std::vector<Check>& checks, const Signature& who) {
  requireCase(session, case_id);
  Decision decision = newDecision(case_id, Verdict::kRejected, requireSigned(who, "rejects"));
  decision.checks = judgedChecks(checks, {});
  if (const RunRecord* run = session.lastRunOf(case_id)) decision.digest = run->digest;
  decision.grounds = judgedGrounds(session, case_id, decision.digest);
  return withDecision(session, std::move(decision));
}

Session reopened(const Session& session, const std::string& case_id, const Signature& who) {
  requireCase(session, case_id);
  const Decision* last = session.decisionOn(case_id);
  if (last == nullptr || last->verdict == Verdict::kReopened)
    throw DecisionError("there is no decision on '" + case_id + "' to take back");
  return withDecision(session, newDecision(case_id, Verdict::kReopened,
                                           requireSigned(who, "takes the decision back")));
}

}  // namespace boresight::sessions
