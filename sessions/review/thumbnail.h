// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "sessions/trace/overlay.h"

namespace boresight::sessions {

/// A small picture of poses: the part of the image that holds the station in each of the poses
/// `framed`, with the station's edges as layers. The core renders them at the picture's own
/// resolution, so that they stay sharp. The whole image when the station is not visible. The sizes
/// are at least 8 px. Prepares the camera itself.
ColorImage stationPicture(const ImageView& image, Camera camera, const MeshView& mesh,
                          std::span<const Pose> framed, std::span<const OverlayLayer> layers,
                          int width_px, int height_px);

}  // namespace boresight::sessions
