// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/review/checks.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// What became of other seeds: enough lead back, and none to another pose.
bool isBasinCheck(const std::string& check_id);
void addBasinChecks(const std::optional<BasinResult>& basin, const CheckLimits& limits,
                    std::vector<Check>& checks);

}  // namespace boresight::sessions
