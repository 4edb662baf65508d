// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/mesh.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The case with a measured pose as its seed. Its uncertainty is three standard deviations along
/// and about each axis of the camera, about the centre of the matched parts, with the mesh's scale
/// and the calibration; at least 1 mm and 0.2 deg. A zero covariance leaves the stated uncertainty.
/// `picture_covariance`: left perturbation, camera frame, of the measurement alone.
SessionCase withMeasuredSeed(SessionCase session_case, const MeshView& mesh,
                             const Pose& camera_from_station, const Matrix6d& picture_covariance);

}  // namespace boresight::sessions
