// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/run/trace.h"
#include "ui/workspaces/step.h"

namespace boresight::ui {

/// What may help a run that failed, and when.
struct Remedy {
  Step step;
  const char* cause;  ///< what is seen, for the operator
};

/// The most likely first; none for a run that converged or has not ended.
const std::vector<Remedy>& remediesFor(const sessions::LocalizationTrace& trace);

}  // namespace boresight::ui
