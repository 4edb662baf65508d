// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/render/camera_scene.h"
#include "core/render/ray_grid.h"

namespace boresight {

/// Rows of the image while they are rendered: per pixel its ray and the nearest surface.
/// Row 0 carries the last row of the band before, so that vertical pairs of pixels meet.
struct RasterBand {
  static constexpr std::int32_t kBackground = -1;  ///< where no face is
  static constexpr std::int32_t kInvalid = -2;     ///< outside the camera's valid field
  /// Depth of a small face that has not been computed yet.
  static constexpr float kUnknownDepth = -1.0F;

  std::span<double> ray_x;         ///< x/z
  std::span<double> ray_y;         ///< y/z
  std::span<float> inverse_depth;  ///< 1/z, 1/m; 0 for background, or kUnknownDepth
  std::span<std::int32_t> face;    ///< or kBackground, kInvalid
  std::span<std::uint8_t> valid;   ///< scratch, one row
  int stride = 0;                  ///< entries from a row to the next one
  int capacity_rows = 0;           ///< carried row included

  int first_y = 0;  ///< image row of band row 1
  int rows = 0;     ///< new rows, carried row excluded
  /// Cost of drawing the new rows: pixels, each counted for every face that covers it, and a share
  /// for every chunk of columns in which a face's edges are tested.
  std::int64_t work_px = 0;
  int x_begin = 0;  ///< columns x_begin .. x_end - 1 are prepared
  int x_end = 0;    ///< the column after the last one drawn

  /// Room for `rows` new rows of `width` pixels.
  static RasterBand create(int width, int rows, Arena& arena);

  /// Index of a pixel's entry.
  std::size_t index(int x, int band_row) const {
    return static_cast<std::size_t>(band_row) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(x);
  }
  /// Direction (x/z, y/z, 1) of a pixel's ray.
  Eigen::Vector3d ray(int x, int band_row) const {
    return {ray_x[index(x, band_row)], ray_y[index(x, band_row)], 1.0};
  }

  /// Keeps the last row as row 0 and clears columns x_first .. x_last of the next `count` rows.
  void advance(const RayGrid& rays, int y, int count, int x_first, int x_last);
};

/// Draws one face into the band's new rows, within `bounds`. A pixel belongs to a face when its ray
/// passes inside all three edges; a ray exactly through an edge belongs to one of the two faces
/// there. The nearest surface wins, then the lower face index, so the order of drawing does not
/// matter. Both orientations are drawn. All depths must be known.
void drawFace(const CameraScene& scene, const RayGrid& rays, std::int32_t face,
              const PixelBounds& bounds, RasterBand& band);

}  // namespace boresight
