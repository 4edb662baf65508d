// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/evaluation/pose_error.h"

namespace boresight::sessions {

/// The largest part of the requirement that the error takes up; above 1: beyond it.
double requirementShare(const PoseError& error, const Requirement& requirement);

/// What exceeds the requirement most of a pose's one sigma, as a clause: "10.4 mm across the view
/// axis at the end effector, 26 times the 0.4 mm required". "" when nothing does, or the covariance
/// is zero. A requirement in pixels is not asked.
std::string sigmaExcessText(const Matrix6d& covariance,
                            const std::optional<Pose>& camera_from_end_effector,
                            const Requirement& requirement);

}  // namespace boresight::sessions
