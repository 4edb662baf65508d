// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"

namespace boresight::sessions {

/// Whether the run on the ground is the one that ran onboard, where the case has its record.
void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks);

}  // namespace boresight::sessions
