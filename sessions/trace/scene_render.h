// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/edge_render.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Salient edges of a scene from one pose, rendered whole by the core with memory of its own; the
/// capacity for edge pixels follows the image. kInvalidMesh and the core's other statuses come back
/// as they are.
Status renderScene(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
                   RenderTrace& output);

}  // namespace boresight::sessions
