// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "sessions/review/check_limits.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"

namespace boresight::sessions {

/// How many of a number of seeds around the case's lead back to the same pose.
struct BasinResult {
  int seeds = 0;
  int converged = 0;
  int returned = 0;             ///< converged to the pose in question, within the requirement
  std::vector<Pose> elsewhere;  ///< of those that converged to another pose
};

/// Runs the case's localization from `seeds` further seeds, drawn evenly in its uncertainty.
/// Deterministic. A stop leaves what was done by then. `after_each` is told what was found so far.
BasinResult basinTest(const ReviewSubject& subject, int seeds, const std::stop_token& stop = {},
                      const std::function<void(const BasinResult&)>& after_each = {});

/// All checks of a pose, always the same ones in the same order; what cannot be asked is not
/// applicable. `basin` is what was measured of it, if it was.
std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const std::optional<BasinResult>& basin = {});

}  // namespace boresight::sessions
