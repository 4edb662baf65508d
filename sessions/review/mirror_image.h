// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sessions/io/scene_mesh.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

/// Mirrors a station in the plane across this axis of its frame (0 to 2) at `plane_m`. Faces keep
/// their outward side.
void mirrorScene(SceneMesh& scene, int axis, double plane_m);

/// The same case with its station mirrored in the plane through the middle of its matched box.
std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis);

}  // namespace boresight::sessions
