// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/localizer/workspace.h"

namespace boresight::sessions {

/// What became of one of several views that were solved as one.
struct ViewOutcome {
  std::string case_id;
  /// As localizationStatusText says; "converged" when it took part in the pose.
  std::string status;

  bool operator==(const ViewOutcome&) const = default;
};

/// Why a view has no part in the pose of all, for the middle of a sentence.
std::string leftOutText(const std::string& status);

/// "together with bc-2 and bc-3 (left out: ...)": the views of a run but this one. Statuses are
/// left away where the run did not converge, or has not ended.
std::string togetherText(const std::vector<ViewOutcome>& views, const std::string& own_case);

}  // namespace boresight::sessions
