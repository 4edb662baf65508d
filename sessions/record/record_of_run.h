// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/localizer/problem.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// The onboard record that the flight side would have written for a run that was traced here, field
/// for field. `given` is what the run was given: nullptr when only the trace is left, and then the
/// hashes of the inputs are missing. What else is not there is named in `missing`: edges, renders
/// and templates of a trace that is a summary, the end of a run that was halted.
OnboardRecord recordOf(const LocalizationTrace& run, const LocalizationProblem* given);

}  // namespace boresight::sessions
