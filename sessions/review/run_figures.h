// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sessions/run/trace.h"

namespace boresight::sessions {

/// Inliers of the last matching iteration; 0 when there was none.
std::int32_t lastInliers(const LocalizationTrace& run);

/// Index of the iteration to look at first: the last one that failed when the run did not converge,
/// else the last one; -1 when there is none.
int iterationToOpen(const LocalizationTrace& run);

}  // namespace boresight::sessions
