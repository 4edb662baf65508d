// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

/// A salient edge pixel. It belongs to the *nearer* of the two surfaces that meet in it.
struct EdgePixel {
  std::int16_t x = 0;  ///< px
  std::int16_t y = 0;  ///< px
  /// z of the nearer surface's plane at the pixel's centre, extended by at most one pixel. For a
  /// face seen at less than 9 deg, whose extended plane is uncertain, z at the line itself.
  float depth_m = 0.0F;
  /// The nearer surface's face (its part and normal follow): the one seen at the pixel, or, where
  /// the pixel lies beyond the surface, the one that ends at the line.
  std::int32_t face = 0;
  std::int8_t normal_x = 0;  ///< unit normal of the line in the image, times 127, pointing from the
  std::int8_t normal_y = 0;  ///< nearer surface to the other side
  std::int8_t offset =
      0;  ///< signed distance from pixel centre to the line along that normal, 1/100 px
  std::uint8_t kind = 0;  ///< EdgeKind bits
};
static_assert(sizeof(EdgePixel) == 16);

enum EdgeKind : std::uint8_t {
  kEdgeCrease = 1,     ///< the normals differ
  kEdgeOccluding = 2,  ///< the depths differ
  kEdgeBorder = 4,     ///< the other side is background
};

/// Salient edges of the scene from one pose (Pham 2025, Sec. III-B): the baseline edge map, its
/// mask, and depth, normal and sub-pixel place at the edge pixels, in raster order.
struct EdgeRender {
  BitImage edges;  ///< 1 at salient edges
  BitImage mask;   ///< 1 where a matched part is the nearest surface, and at every edge pixel
  std::span<EdgePixel> pixels;        ///< capacity; the first `pixel_count` are valid, raster order
  std::span<std::int32_t> row_begin;  ///< height + 1 indices into pixels
  std::int32_t pixel_count = 0;       ///< salient edge pixels
  /// Words for the largest image; `edges` and `mask` use the words that the current camera needs.
  std::span<std::uint64_t> edge_words;
  std::span<std::uint64_t> mask_words;  ///< of the mask, likewise
  Camera camera;                        ///< the camera at this level
  Pose camera_from_station;             ///< the pose rendered
};

}  // namespace boresight
