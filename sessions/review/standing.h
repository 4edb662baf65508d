// SPDX-License-Identifier: Apache-2.0
// Where a case stands: what was run, marked and decided, and whether a decision still holds.
#pragma once

#include <string>
#include <string_view>

#include "sessions/session/session.h"

namespace boresight::sessions {

enum class CaseStanding { kNew, kConverged, kFailed, kAnnotated, kValidated, kRejected };
/// "new", "converged", "failed", "annotated", "validated", "rejected".
const char* caseStandingText(CaseStanding standing);

struct Standing {
  CaseStanding state = CaseStanding::kNew;
  /// The last decision, also when it does not hold; nullptr: there is none. Points into the
  /// session.
  const Decision* decision = nullptr;
  bool holds = false;   ///< the decision does
  std::string dropped;  ///< why it does not: "the image or another input of runs has changed"
  bool awaits_approval = false;  ///< validated by one person where two are asked for
};

/// A decision holds while everything that was judged is what it was then; a validation that awaits
/// its second person does not make a case validated.
Standing standingOf(const Session& session, const std::string& case_id);

/// The standing in words: "validated by A, approved by B", "not validated: converged", "not
/// validated: converged; A's validation no longer holds, as ...".
std::string standingText(const Standing& standing);

}  // namespace boresight::sessions
