// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/standing.h"

#include "sessions/review/grounds.h"

namespace boresight::sessions {
namespace {

CaseStanding undecided(const Session& session, const std::string& case_id) {
  if (const RunRecord* run = session.lastRunOf(case_id))
    return run->status == "converged" ? CaseStanding::kConverged : CaseStanding::kFailed;
  return session.annotations.count(case_id) > 0 ? CaseStanding::kAnnotated : CaseStanding::kNew;
}

/// Why a decision no longer holds, or "".
std::string droppedText(const Session& session, const Decision& decision) {
  if (decision.grounds.empty() || (decision.verdict == Verdict::kValidated && !decision.pose))
    return "it does not say what it is of";
  const bool of_run = !decision.digest.empty();
  const RunRecord* last = session.lastRunOf(decision.case_id);
  if (of_run && last == nullptr) return "its run is no longer there";
  if (of_run && last->digest != decision.digest) return "there is a later run";
  return changedGroundsText(decision.grounds,
                            judgedGrounds(session, decision.case_id, decision.digest));
}

std::string byText(const Decision& decision) {
  std::string text = " by " + decision.by;
  if (decision.approval) text += ", approved by " + decision.approval->by;
  return text;
}

}  // namespace

const char* caseStandingText(CaseStanding state) {
  constexpr const char* kTexts[] = {"new",       "converged", "failed",
                                    "annotated", "validated", "rejected"};
  return kTexts[static_cast<std::size_t>(state)];
}

Standing standingOf(const Session& session, const std::string& case_id) {
  Standing standing;
  standing.state = undecided(session, case_id);
  const Decision* decision = session.decisionOn(case_id);
  if (decision == nullptr || decision->verdict == Verdict::kReopened) return standing;
  standing.decision = decision;
  standing.dropped = droppedText(session, *decision);
  if (!standing.holds()) return standing;
  if (decision->verdict == Verdict::kRejected) {
    standing.state = CaseStanding::kRejected;
  } else if (session.review.second_person && !decision->approval) {
    standing.awaits_approval = true;
  } else {
    standing.state = CaseStanding::kValidated;
  }
  return standing;
}

std::string standingText(const Standing& standing) {
  if (standing.state == CaseStanding::kValidated) return "validated" + byText(*standing.decision);
  if (standing.state == CaseStanding::kRejected)
    return "NOT VALIDATED: rejected" + byText(*standing.decision);
  const std::string text = std::string("NOT VALIDATED: ") + caseStandingText(standing.state);
  if (standing.awaits_approval)
    return text + "; validated" + byText(*standing.decision) + ", a second person has to approve";
  if (standing.decision == nullptr) return text;
  const char* what = standing.decision->verdict == Verdict::kValidated ? "validation" : "rejection";
  return text + "; the " + what + byText(*standing.decision) +
         " no longer holds: " + standing.dropped;
}

}  // namespace boresight::sessions
