// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Why a run from this seed makes no sense, or "": the matched parts lie behind the camera, or
/// nothing of them is inside the image. Whether what is seen suffices is for the run to find out.
std::string seedConcern(const Camera& camera, const MeshView& mesh,
                        const Pose& camera_from_station_seed);

}  // namespace boresight::sessions
