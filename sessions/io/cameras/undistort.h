// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"

namespace boresight::sessions {

/// An image as a camera without distortion would have taken it.
struct UndistortedImage {
  Camera camera;                     ///< pinhole
  std::vector<std::uint8_t> pixels;  ///< row-major, 0 where the camera does not see

  ImageView view() const { return {pixels.data(), camera.width, camera.height, camera.width}; }
};

/// The pinhole camera with the same centre, size, focal lengths and principal point, no distortion.
Camera pinholeOf(const Camera& camera);

/// The image resampled (bilinear) through the core's camera model; a render without distortion from
/// the same pose lies on it. A pinhole image is returned unchanged. The image must have the
/// camera's size.
UndistortedImage undistort(const Camera& camera, const ImageView& image);

}  // namespace boresight::sessions
