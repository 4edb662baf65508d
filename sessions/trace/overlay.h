// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Blue, green, red, as OpenCV keeps them.
using ColorBgr = std::array<std::uint8_t, 3>;
/// The colours of the window, distinct also without red or green (Okabe and Ito 2008).
///@{
inline constexpr ColorBgr kSeedColor = {0, 159, 230};       ///< orange
inline constexpr ColorBgr kResultColor = {233, 180, 86};    ///< blue
inline constexpr ColorBgr kDoubtfulColor = {200, 92, 255};  ///< pink
inline constexpr ColorBgr kTruthColor = {255, 255, 255};
///@}

/// 8-bit colour, row-major, 3 bytes per pixel.
struct ColorImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bgr;
};

/// The scene's salient edges from one pose.
struct OverlayLayer {
  std::string label;
  Pose camera_from_station;
  ColorBgr color{};
  bool thin = false;  ///< drawn narrower, so that an earlier layer shows on both sides
};

/// The image in gray with the layers drawn over it in their order, each rendered by the core at
/// full resolution, and a legend in the upper left corner if any of them has a label. A layer that
/// cannot be rendered (its pose behind the camera) is marked so in the legend.
ColorImage drawOverlay(const ImageView& image, const Camera& camera, const MeshView& mesh,
                       std::span<const OverlayLayer> layers);

/// Atomically, as PNG; OutputError.
void writeColorPng(const std::filesystem::path& file, const ColorImage& image);

}  // namespace boresight::sessions
