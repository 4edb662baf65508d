// SPDX-License-Identifier: Apache-2.0
// Where a case stands: what was run, marked and decided, and whether a decision still holds.
#pragma once

#include <map>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

enum class CaseStanding { kNew, kConverged, kFailed, kAnnotated, kValidated, kRejected };
/// "new", "converged", "failed", "annotated", "validated", "rejected".
const char* caseStandingText(CaseStanding state);

struct Standing {
  CaseStanding state = CaseStanding::kNew;
  /// The last decision, also when it does not hold; nullptr: there is none, or it was taken back.
  /// Points into the session.
  const Decision* decision = nullptr;
  std::string dropped;           ///< why it does not hold: "the marks have changed"; "": it does
  bool awaits_approval = false;  ///< validated by one person where two are asked for

  bool holds() const { return decision != nullptr && dropped.empty(); }
  /// The decision where it holds and is of a pose, else nullptr.
  const Decision* judgedPose() const { return holds() && decision->pose ? decision : nullptr; }
};

/// A decision holds while everything that was judged is what it was then, and no other run has
/// come after. A validation that awaits its second person holds, but the case is not validated yet.
Standing standingOf(const Session& session, const std::string& case_id);

/// The standing in words, never less than the truth: "validated by A, approved by B", "NOT
/// VALIDATED: converged", "NOT VALIDATED: converged; the validation by A no longer holds, as the
/// marks have changed".
std::string standingText(const Standing& standing);

/// SHA-256 by name: "inputs" (of runs), "run" (its digest), "marks" (of the case and its rig),
/// "truth", "input_sigmas", "requirement", "end_effector", "rig", "other_runs" (of the rig's other
/// cameras, where they have one), "onboard_record", "limits". Not the options: those of a run are
/// part of its digest. `run_digest` is empty for what rests on no run. Empty when there is no such
/// case.
std::map<std::string, std::string> judgedGrounds(const Session& session, const std::string& case_id,
                                                 const std::string& run_digest);

/// What differs, as a clause: "the marks and the requirement have changed"; empty when nothing.
std::string changedGroundsText(const std::map<std::string, std::string>& before,
                               const std::map<std::string, std::string>& now);

}  // namespace boresight::sessions
