// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// How far the pose is from what else is known: the case's marks, its truth, the other cameras of
/// its rig (the one that is farthest off).
void addAgreementChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

/// Whether a pose lies within everything that a requirement names of another one.
bool withinRequirement(const ReviewSubject& subject, const Pose& camera_from_station);

/// The pose's covariance, mesh scale and calibration included, against each thing that the
/// requirement names: translations at the end effector, or at the camera where that is not known.
void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

}  // namespace boresight::sessions
