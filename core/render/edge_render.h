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
#include "core/render/camera_scene.h"
#include "core/render/edge_pixel.h"
#include "core/render/face_bins.h"
#include "core/render/rasterizer.h"
#include "core/render/ray_grid.h"
#include "core/render/salient_edges.h"
#include "core/render/surface_render.h"

namespace boresight {

struct RenderOptions {
  double near_plane_m = 0.01;
  std::int32_t max_edge_pixels = 80000;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"render.near_plane_m", "m", 1e-6, 1000.0,
                     "Surfaces nearer than this are not rendered."},
          self.near_plane_m);
    visit(OptionInfo{"render.max_edge_pixels", "", 1000, 4000000,
                     "Capacity for salient edge pixels of a render at the finest level; half as "
                     "many at the level before."},
          self.max_edge_pixels);
  }
};

/// Sizes an EdgeRender for images up to width x height and `max_edge_pixels` edge pixels.
EdgeRender createEdgeRender(int width, int height, std::int32_t max_edge_pixels, Arena& arena);
inline EdgeRender createEdgeRender(int width, int height, const RenderOptions& options,
                                   Arena& arena) {
  return createEdgeRender(width, height, options.max_edge_pixels, arena);
}

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

/// Renders in bands of rows; memory is one band, not an image, and the mesh in the camera frame.
/// The result does not depend on the bands' height.
class EdgeRenderer {
 public:
  static constexpr int kBandRows = 16;

  /// `max_width` x `max_height` bound every camera that will be rendered with. The mesh and its
  /// adjacency must outlive the renderer. Counting arenas only count. kInvalidMesh, kInvalidImage
  /// (size), kInvalidOption, kArenaTooSmall.
  Status create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width, int max_height,
                const RenderOptions& options, Arena& arena, int band_rows = kBandRows) {
    return create(mesh, adjacency, max_width, max_height, options, arena, arena, band_rows);
  }
  /// The same with what is only needed from begin() to the last step in `scratch`: between two
  /// renders somebody else may use that memory.
  Status create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width, int max_height,
                const RenderOptions& options, Arena& kept, Arena& scratch,
                int band_rows = kBandRows);
  /// Draws small faces like all others, for comparison: the result is the same.
  void drawPlainly(bool plain) { plain_ = plain; }
  /// Starts one render; rays must be made for the camera of this level, and outlive the steps, as
  /// must the output. kInvalidPose, kInvalidImage when the output or the renderer is too small.
  Status begin(const RayGrid& rays, const Pose& camera_from_station, EdgeRender& output,
               const SurfaceRender& surfaces = {});
  /// One slice: some thousand vertices or faces, or a band; `done` when the render is complete.
  /// kCapacityExceeded when max_edge_pixels is not enough: the rows before are valid, `done` set.
  Status step(bool& done);

 private:
  enum class Phase : std::uint8_t { kIdle, kVertices, kFaces, kBands };
  using Columns = FaceBins::Columns;

  bool drawSome();
  Columns columnsAround(int band, int before, int after) const;
  void openBand();
  Status closeBand();

  CameraScene scene_;
  RasterBand band_;
  SalientEdges salient_edges_;
  FaceBins bins_;
  int max_width_ = 0;
  int max_height_ = 0;
  int band_rows_ = kBandRows;

  const RayGrid* rays_ = nullptr;
  EdgeRender* output_ = nullptr;
  SurfaceRender surfaces_;
  Phase phase_ = Phase::kIdle;
  std::size_t next_ = 0;  ///< vertex, face or band to go on with
  bool plain_ = false;
  bool band_open_ = false;
  int list_ = 0;                  ///< of the open band's faces
  std::int32_t next_drawn_ = -1;  ///< face of that list to go on with
};

}  // namespace boresight
