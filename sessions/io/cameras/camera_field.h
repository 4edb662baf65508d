// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/camera.h"

namespace boresight::sessions {

/// Why the distortion is implausible for an image of this size, as one sentence; empty when it is
/// plausible. A distortion that folds back (the distance from the axis in the image shrinks as the
/// angle grows) leaves all pixels beyond the fold without a ray. Up to a quarter of them are
/// accepted, and any number beyond a fold at 80 deg or more: a fisheye's image is a circle.
std::string fieldConcern(const Camera& camera);

/// InputError when there is a fieldConcern; `field` names the camera in the file.
void requireField(const std::filesystem::path& file, const std::string& field,
                  const Camera& camera);

}  // namespace boresight::sessions
