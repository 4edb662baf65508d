// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Ids of the later session's cases of which a person has changed something since the earlier one
/// (the case itself, its marks or passes, decisions on it); new ones too, in their order. Runs and
/// the view do not count.
std::vector<std::string> changedCases(const Session& before, const Session& after);

}  // namespace boresight::sessions
