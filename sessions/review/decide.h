// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// A decision that is not allowed; `what()` is a sentence for people.
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
bool samePerson(const std::string& one, const std::string& other);

/// Reasons for passing over failed checks, by their ids.
using CheckOverrides = std::map<std::string, std::string>;

/// Why this pose cannot be validated now, or "": the run did not converge, it is stale (inputs or
/// options have changed since), or it is not the case's last one.
std::string validationConcern(const Session& session, const ReviewSubject& subject);

/// Vouches for a pose: with a name, a comment, and every check passed or passed over with a reason.
/// `basin_seeds` is the number of further seeds that the checks rest on, 0: none. DecisionError
/// otherwise.
Session validated(const Session& session, const ReviewSubject& subject,
                  const std::vector<Check>& checks, const CheckOverrides& overrides,
                  const Signature& who, int basin_seeds = 0);

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
