// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/record/onboard_record.h"
#include "sessions/run/run_plan.h"

namespace boresight::sessions {

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
