// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sessions/run/run_snapshot.h"

namespace boresight::sessions {

/// Inliers of the last matching iteration; 0 when there was none.
std::int32_t lastInliers(const RunSnapshot& run);

/// Index of the iteration to look at first: the last one that failed when the run did not converge,
/// else the last one; -1 when there is none.
int iterationToOpen(const RunSnapshot& run);

}  // namespace boresight::sessions
