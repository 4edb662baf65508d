// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// What a run says of itself: that it converged, that its corrections shrink, and its last
/// matching iteration's inliers, their spread, window borders and margins. Always the same checks
/// in the same order; not applicable to a pose from marks.
void addRunChecks(const ReviewSubject& subject, const CheckLimits& limits,
                  std::vector<Check>& checks);

}  // namespace boresight::sessions
