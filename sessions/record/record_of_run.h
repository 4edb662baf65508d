// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/localizer/problem.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/run_plan.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// The onboard record that the flight side would have written for a run that was traced here, field
/// for field. `given` is what the run was given: nullptr when only the trace is left, and then the
/// hashes of the inputs are missing. What else is not there is named in `missing`: edges, renders
/// and templates of a trace that is a summary, the end of a run that was halted.
OnboardRecord recordOf(const LocalizationTrace& run, const LocalizationProblem* given);

/// The options of an onboard run as this program understands them.
struct RecordedPlan {
  RunPlan plan;
  /// What is not as it was on board, sentences: options that this program does not know or whose
  /// value it does not take, options that the record lacks (these have their default).
  std::vector<std::string> remarks;
  bool has_options = false;  ///< false: the record has none, and all have their default
};
RecordedPlan planOf(const OnboardRecord& record);

}  // namespace boresight::sessions
