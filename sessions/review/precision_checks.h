// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/review/check_limits.h"
#include "sessions/review/predicted_edges.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"

namespace boresight::sessions {

/// The pose's covariance, with the calibration's share where it is known, against each thing that
/// the requirement names.
void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        const PredictedEdges& edges, std::vector<Check>& checks);

}  // namespace boresight::sessions
