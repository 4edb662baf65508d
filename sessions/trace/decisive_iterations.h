// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Whether the iteration has a pose.
bool cameToPose(const IterationTrace& iteration);

/// The iterations that led to the run's pose, in order: those of the last attempt. A run that
/// compares hypotheses ends with an attempt that repeats the last iteration of the best one: the
/// earlier iterations of that hypothesis come first.
std::vector<std::shared_ptr<const IterationTrace>> decisiveIterations(const LocalizationTrace& run);

/// The last decisive iteration that matched; nullptr: none.
std::shared_ptr<const IterationTrace> lastMatching(const LocalizationTrace& run);

}  // namespace boresight::sessions
