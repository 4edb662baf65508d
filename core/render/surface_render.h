// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/render/camera_scene.h"
#include "core/render/rasterizer.h"

namespace boresight {

/// Optional outputs of a render, for display and for methods that compare intensities; never needed
/// by the flight loop. Each span is empty (not requested) or has width * height entries, row by
/// row, of the camera rendered with.
struct SurfaceRender {
  std::span<float> depth_m;           ///< z at the pixel's centre; 0 for background
  std::span<std::int32_t> face;       ///< -1 for background
  std::span<std::uint8_t> intensity;  ///< Lambert, lit from the camera: 30 + 225 |n . ray|
  std::span<Eigen::Vector3f> normal_in_camera;  ///< unit, towards the camera; 0 for background

  /// Whether any output is requested.
  bool wanted() const {
    return !depth_m.empty() || !face.empty() || !intensity.empty() || !normal_in_camera.empty();
  }
};

/// True when every span is empty or large enough.
[[nodiscard]] bool surfaceRenderFits(const SurfaceRender& surfaces, int width, int height);

/// Copies the new rows of a band, all of whose depths are known.
void copySurfaces(const CameraScene& scene, const RasterBand& band, const Camera& camera,
                  const SurfaceRender& surfaces);

}  // namespace boresight
