// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/geometry/pose.h"

namespace boresight::sessions {

/// The motion of the station that is by far the least certain under a pose's covariance, as a
/// clause: "4.6 deg (1 sigma) about the station's z axis", "12.0 mm (1 sigma) along the station's
/// direction (0.71, 0.71, 0.00)". "" when no motion stands out. For rotations and translations
/// alike, the largest sigma must be at least 5 times the next; a rotation is reported before a
/// translation. The covariance is over (rotation rad, translation m) of the left perturbation in
/// the camera frame.
std::string leastKnownText(const Matrix6d& covariance, const Pose& camera_from_station);

}  // namespace boresight::sessions
