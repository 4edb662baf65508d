// SPDX-License-Identifier: Apache-2.0
// Where a case stands: what was run, annotated and decided, and whether a decision still holds.
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
  /// The last decision, also when it does not hold; nullptr: there is none, or it was taken back.
  /// Points into the session.
  const Decision* decision = nullptr;
  std::string dropped;  ///< why it does not hold: "the annotations have changed"; "": it does
  /// Why the run of a validation that holds would be another one now: "the run was made with other
  /// options"; "": it would not.
  std::string outdated;
  bool awaits_approval = false;  ///< validated by one person where two are asked for

  bool holds() const { return decision != nullptr && dropped.empty(); }
  /// The decision where it holds and is of a pose, else nullptr.
  const Decision* judgedPose() const { return holds() && decision->pose ? decision : nullptr; }
};

/// A decision holds while everything that was judged is what it was then, and no other run has
/// come after. A validation that awaits its second person holds, but the case is not validated yet.
ReviewStatus reviewStatusOf(const Session& session, const std::string& case_id);

/// The status in words, never less than the truth: "validated by A, approved by B", "validated by
/// A; outdated: the run was made with other options", "NOT VALIDATED: converged", "NOT
/// VALIDATED: converged; the validation by A no longer holds: the annotations have changed".
std::string reviewStatusText(const ReviewStatus& status);

/// SHA-256 by name: "inputs" (of runs), "run" (its digest), "annotations" (of the case and its
/// rig), "truth", "input_sigmas", "requirement", "end_effector", "rig", "other_runs" (of the rig's
/// other cameras, where they have one), "onboard_record", "limits". Not the options: those of a run
/// are part of its digest. `run_digest` is empty for what rests on no run. Empty when there is no
/// such case.
std::map<std::string, std::string> inputFingerprint(const Session& session,
                                                    const std::string& case_id,
                                                    const std::string& run_digest);

/// What differs, as a clause: "the annotations and the requirement have changed"; empty when
/// nothing.
std::string changedInputsText(const std::map<std::string, std::string>& before,
                              const std::map<std::string, std::string>& after);

/// A decision that is not allowed; `what()` is one readable sentence.
class DecisionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Who decides, and what they say.
struct Signature {
  std::string by;
  std::string comment;
};

/// Whether two names are one person's, whatever the case of their letters and their blanks.
bool samePerson(const std::string& text, const std::string& other);

/// Reasons for passing over failed checks, by their ids.
using CheckWaivers = std::map<std::string, std::string>;

/// Why this pose cannot be validated now, or "": the run did not converge, it is stale (inputs or
/// options have changed since), or it is not the case's last one.
std::string validationConcern(const Session& session, const ReviewSubject& subject);

/// Vouches for a pose: with a name, a comment, and every check passed or passed over with a reason.
/// `convergence_seeds` is the number of further seeds that the checks rest on, 0: none.
/// DecisionError otherwise.
Session validated(const Session& session, const ReviewSubject& subject,
                  const std::vector<Check>& checks, const CheckWaivers& waivers,
                  const Signature& who, int convergence_seeds = 0);

/// The second person's yes to a validation that holds. DecisionError when there is none, or when it
/// is the first person again (whatever the case or blanks of the name).
Session approved(const Session& session, const std::string& case_id, const Signature& who);

/// Refuses a case's result, with a name and a reason; works without any pose. Checks that are
/// known are kept with it.
Session rejected(const Session& session, const std::string& case_id,
                 const std::vector<Check>& checks, const Signature& who);

/// Takes the decision back, with a name and a reason; both stay in the session's history.
Session reopened(const Session& session, const std::string& case_id, const Signature& who);

}  // namespace boresight::sessions
