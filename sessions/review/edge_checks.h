// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/review/predicted_edges.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// What the image's edges say of the final pose, measured anew and not by the run's own gate:
/// coverage, clutter and fall-off kept apart, and whether they ask for another camera.
void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks);

}  // namespace boresight::sessions
