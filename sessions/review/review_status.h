// SPDX-License-Identifier: Apache-2.0
// Review status of a case: its runs, annotations and decisions, and whether a decision still holds.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sessions/checks/review_subject.h"
#include "sessions/decision/check.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

enum class ReviewState { kNew, kConverged, kFailed, kAnnotated, kValidated, kRejected };
/// "new", "converged", "failed", "annotated", "validated", "rejected".
const char* reviewStateText(ReviewState state);

struct ReviewStatus {
  ReviewState state = ReviewState::kNew;
  /// The last decision, also when it does not hold; nullptr: there is none, or it was reopened.
  /// Points into the session.
  const Decision* decision = nullptr;
  std::string dropped;  ///< reason why the decision does not hold: "the annotations have changed";
                        ///< "": it holds
  /// Why the run of a validation that holds would differ if repeated: "the run was made with other
  /// options"; "": it would not.
  std::string outdated;
  bool awaits_approval = false;  ///< validated by one person where two are required

  bool holds() const { return decision != nullptr && dropped.empty(); }
  /// The decision if it holds and concerns a pose, else nullptr.
  const Decision* judgedPose() const { return holds() && decision->pose ? decision : nullptr; }
};

/// A decision holds while all inputs that were judged are unchanged, and no other run has followed.
/// A validation that awaits its second person holds, but the case is not validated yet.
ReviewStatus reviewStatusOf(const Session& session, const std::string& case_id);

/// The status in words: "validated by A, approved by B", "validated by A; outdated: the run was
/// made with other options", "NOT VALIDATED: converged", "NOT VALIDATED: converged; the validation
/// by A no longer holds: the annotations have changed".
std::string reviewStatusText(const ReviewStatus& status);

/// SHA-256 by name of all that a decision depends on: dependencyDigests of the case, "run" (its
/// digest), "annotations" (of the case and its rig), "rig" (with the inputs of its other cameras),
/// "other_runs" (theirs), "limits". Not the options: those of a run are part of its digest.
/// `run_digest` is empty for a pose without a run; every other name is always there. Empty when the
/// case does not exist.
std::map<std::string, std::string> inputFingerprint(const Session& session,
                                                    const std::string& case_id,
                                                    const std::string& run_digest);

/// The differences, as a clause: "the annotations and the requirement have changed"; empty without
/// differences. A name that `before` lacks was not recorded by the version that decided: its data
/// is not covered, and the clause names it.
std::string changedInputsText(const std::map<std::string, std::string>& before,
                              const std::map<std::string, std::string>& after);

/// A decision that is not allowed; `what()` is one readable sentence.
class DecisionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Name and comment of the person who decides.
struct Signature {
  std::string by;
  std::string comment;
};

/// Whether two names denote the same person: letters and digits count (lettersOf), whatever their
/// case.
bool samePerson(const std::string& text, const std::string& other);

/// Reasons for waiving failed checks, by check id.
using CheckWaivers = std::map<std::string, std::string>;

/// Why this pose cannot be validated now, or "": the run did not converge, is stale (inputs or
/// options have changed since), or is not the case's last run.
std::string validationConcern(const Session& session, const ReviewSubject& subject);

/// Validates a pose: requires a name, a comment, and every check passed or waived with a reason;
/// otherwise DecisionError. `convergence_seeds`: number of seeds of the convergence test, 0: none.
Session validated(const Session& session, const ReviewSubject& subject,
                  const std::vector<Check>& checks, const CheckWaivers& waivers,
                  const Signature& who, int convergence_seeds = 0);

/// Digest of the case's last run, or empty.
std::string lastRunDigest(const Session& session, const std::string& case_id);

/// Approves a validation that holds, as a second person who has seen the run `seen_run` (its
/// digest; empty: none). DecisionError when there is no such validation, when it is of another run,
/// or when it is the same person (samePerson).
Session approved(const Session& session, const std::string& case_id, const std::string& seen_run,
                 const Signature& who);

/// Rejects a case's result, with a name and a reason; works without any pose. DecisionError when
/// the run that was seen is not the last one. Known checks are stored with the decision.
Session rejected(const Session& session, const std::string& case_id, const std::string& seen_run,
                 const std::vector<Check>& checks, const Signature& who);

/// Reopens a case, with a name and a reason: its decision no longer holds, but stays in the
/// session's history.
Session reopened(const Session& session, const std::string& case_id, const Signature& who);

}  // namespace boresight::sessions
