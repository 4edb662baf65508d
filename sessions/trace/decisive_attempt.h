// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Whether the iteration has a pose.
bool cameToPose(const IterationTrace& iteration);

/// The iterations of the attempt that led to the run's pose: the last one. A run that compares
/// hypotheses ends with the last iteration of the best one repeated: then the attempt of that
/// hypothesis.
std::vector<std::shared_ptr<const IterationTrace>> decisiveAttempt(const LocalizationTrace& run);

/// The last iteration of the decisive attempt that matched; nullptr: none.
std::shared_ptr<const IterationTrace> lastMatching(const LocalizationTrace& run);

}  // namespace boresight::sessions
