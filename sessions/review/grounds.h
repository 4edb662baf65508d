// SPDX-License-Identifier: Apache-2.0
// What a judgement of a case rests on, so that a later change of it can be told.
#pragma once

#include <map>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

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
