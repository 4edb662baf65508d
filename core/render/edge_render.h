// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/options.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight {

struct RenderOptions {
  double near_plane_m = 0.01;
  std::int32_t max_edge_pixels = 200000;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"render.near_plane_m", "m", 1e-6, 1000.0,
                     "Surfaces nearer than this are not rendered."},
          self.near_plane_m);
    visit(OptionInfo{"render.max_edge_pixels", "", 1000, 4000000,
                     "Capacity for salient edge pixels."},
          self.max_edge_pixels);
  }
};

/// Undistorted rays of an image's pixels, interpolated on a coarse grid: the camera does not change
/// between iterations, and unprojecting a distorted pixel is an iteration of its own.
/// Interpolated (x/z, y/z) is within 1e-9 of `unproject` where the model is smooth on the grid's
/// scale.
class RayGrid {
 public:
  static Status create(const Camera& camera, Arena& arena, RayGrid& grid);
  /// (x/z, y/z) of pixels (x_begin .. x_begin + count - 1, y); NaN-free: pixels outside the model's
  /// valid field get `valid[i] == 0`.
  void row(int y, int x_begin, int count, double* x_over_z, double* y_over_z,
           std::uint8_t* valid) const;
  const Camera& camera() const { return camera_; }

 private:
  Camera camera_;
  // (the implementer of this stage fills this in)
};

/// The scene prepared for rendering: the caller's mesh, its adjacency, and per-vertex and per-face
/// working memory that is refilled for every pose.
struct RenderScene;

/// What is known of one salient edge pixel. It belongs to the *nearer* of the two surfaces that
/// meet in it.
struct EdgePixel {
  std::int16_t x = 0;
  std::int16_t y = 0;
  float depth_m = 0.0F;      ///< z of the nearer surface's plane at the pixel's centre
  std::int32_t face = 0;     ///< the nearer surface's face (its part and normal follow)
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

/// Salient edges of the scene from one pose (Pham 2025, Sec. III-A): the baseline edge map, its
/// mask, and depth, normal and sub-pixel place at the edge pixels, in raster order.
struct EdgeRender {
  BitImage edges;
  BitImage mask;  ///< 1 where a matched part is the nearest surface, and at every edge pixel
  std::span<EdgePixel> pixels;        ///< capacity; the first `pixel_count` are valid, raster order
  std::span<std::int32_t> row_begin;  ///< height + 1 indices into pixels
  std::int32_t pixel_count = 0;
  Camera camera;  ///< the camera at this level
  Pose camera_from_station;
};

/// Sizes an EdgeRender for images up to width x height.
EdgeRender createEdgeRender(int width, int height, const RenderOptions& options, Arena& arena);

/// The pixel's index in `render.pixels`, or -1 (binary search in its row).
std::int32_t findEdgePixel(const EdgeRender& render, int x, int y);

/// 3D point of an edge pixel in the station frame: back-projection of its centre with its depth.
[[nodiscard]] bool edgePointInStation(const EdgeRender& render, const EdgePixel& pixel,
                                      Eigen::Vector3d& point_in_station_m);

/// The line's own place nearest to the pixel's centre: sub-pixel position (centre + offset *
/// normal), and the 3D point of the nearer surface there, given that surface's face.
[[nodiscard]] bool edgeLinePoint(const EdgeRender& render, const MeshView& mesh,
                                 const EdgePixel& pixel, Eigen::Vector2d& position_px,
                                 Eigen::Vector3d& point_in_station_m);

/// Renders in bands of rows with an apron; memory is one band, not an image.
class EdgeRenderer {
 public:
  /// `max_width` x `max_height` bound every camera that will be rendered with. The mesh and its
  /// adjacency must outlive the renderer. Counting arenas only count.
  Status create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width, int max_height,
                const RenderOptions& options, Arena& arena);
  /// Starts one render; rays must be made for the camera of this level.
  Status begin(const RayGrid& rays, const Pose& camera_from_station, EdgeRender& output);
  /// One band; `done` when the render is complete. kCapacityExceeded when max_edge_pixels is not
  /// enough.
  Status step(bool& done);

 private:
  // (the implementer of this stage fills this in)
};

}  // namespace boresight
