// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// What differs between two states of a session. The cost grows with the difference, not with the
/// session, for states that share their elements.
struct SessionDifference {
  bool list = false;     ///< cases were added, removed or renamed
  bool options = false;  ///< profile or options, of all cases
  bool review = false;   ///< review settings, of all cases
  bool robust = false;   ///< how annotations are solved, of all cases
  /// Ids of the cases that differ, in themselves, their annotations, rounds, decisions or runs;
  /// also of those that were added or removed.
  std::set<std::string> cases;

  bool ofAllCases() const { return options || review || robust; }
};
SessionDifference differenceOf(const Session& before, const Session& after);

/// Adds the other cases of the rigs that these cases have in one of two states of the session:
/// their checks depend on each other.
std::set<std::string> withCasesOfRigs(std::set<std::string> ids, const Session& before,
                                      const Session& after);

}  // namespace boresight::sessions
