// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/pose_file.h"

namespace boresight::sessions {

/// Offset (r rad, t m) of a truth from a seed: r and t each uniform in the ellipsoid inscribed in
/// the uncertainty's box, both scaled by `scale`. The same case and number always give the same
/// offset, on every machine.
Vector6d drawOffset(const DeclaredUncertainty& uncertainty, double scale,
                    const std::string& case_id, int number);

/// The seed from which `camera_from_station_true` is displaced by `offset` about the pivot:
/// p_true = Exp(r) (p_seed - c) + c + t, where c is the camera's centre, or where the seed sees the
/// centre of the matched parts.
Pose seedForOffset(const Pose& camera_from_station_true, const Vector6d& offset,
                   UncertaintyPivot pivot, const Eigen::Vector3d& matched_centre_in_station_m);

}  // namespace boresight::sessions
