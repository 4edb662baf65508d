// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
#include "core/render/band_painter.h"
#include "core/render/camera_scene.h"
#include "core/render/edge_pixel.h"
#include "core/render/face_bins.h"
#include "core/render/ray_grid.h"
#include "core/render/surface_render.h"

namespace boresight {

/// Options of the render of salient edges.
struct RenderOptions {
  std::int32_t max_edge_pixels = 80000;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
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

/// The point of the line nearest to the pixel's centre: sub-pixel position (centre + offset *
/// normal), and the 3D point of the nearer surface there, given that surface's face.
[[nodiscard]] bool edgeLinePoint(const EdgeRender& render, const MeshView& mesh,
                                 const EdgePixel& pixel, Eigen::Vector2d& position_px,
                                 Eigen::Vector3d& point_in_station_m);

/// Renders in bands of rows; memory is one band, not an image, and the mesh in the camera frame.
/// The result does not depend on the bands' height.
///
/// With several workers each phase (vertices, faces, bands) consists of tasks that may be done at
/// the same time, and the result does not depend on the assignment of tasks to workers:
///
///     while (!done) {
///       for task in 0 ... tasks() - 1, at the same time:  runTask(task, worker)
///       step(done)
///     }
class EdgeRenderer {
 public:
  static constexpr int kBandRows = 16;  ///< rows drawn at a time
  /// Rows of a band for images of this width: wider bands are lower, so that their memory (with the
  /// row carried over) does not grow.
  static constexpr int bandRowsOf(int width) {
    if (width <= kFullBand_px) return kBandRows;
    return std::max(1, (kBandRows + 1) * kFullBand_px / width - 1);
  }

  /// `max_width` x `max_height` bound every camera that will be rendered with. The mesh and its
  /// adjacency must outlive the renderer. Counting arenas only count. kInvalidMesh (also of more
  /// than PackedEdgePixel::kMostFaces faces), kInvalidImage
  /// (size), kInvalidOption, kArenaTooSmall.
  Status create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width, int max_height,
                const RenderOptions& options, Arena& arena, int band_rows = kBandRows,
                int workers = 1) {
    return create(mesh, adjacency, max_width, max_height, options, arena, arena, band_rows,
                  workers);
  }
  /// The same with temporary data (from begin() to the last step) in `scratch`, which may be reused
  /// between two renders. Each worker takes the memory of a band; several workers also take room
  /// for all edge pixels.
  Status create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width, int max_height,
                const RenderOptions& options, Arena& kept, Arena& scratch,
                int band_rows = kBandRows, int workers = 1);
  /// Draws small faces like other faces, for comparison: the result is the same.
  void drawPlainly(bool plain) { plain_ = plain; }
  /// Starts one render; `rays` must be those of the camera of this level. Rays and output must
  /// outlive the steps. kInvalidPose, kInvalidImage when the output or the renderer is too small.
  /// In a view that is turned from the camera, the rays and the pose are the view's, and
  /// `view_from_camera` places the parts that are fixed to the camera.
  Status begin(const RayGrid& rays, const Pose& camera_from_station, EdgeRender& output,
               const SurfaceRender& surfaces = {}, const Pose& view_from_camera = Pose());
  /// One slice: some thousand vertices or faces, or a band; `done` when the render is complete.
  /// kCapacityExceeded when max_edge_pixels is not enough, kTooManyLayers when a band has more than
  /// BandPainter::kMostLayers: the rows before are valid, `done` set. With several workers, ends
  /// the phase when all its tasks are done.
  Status step(bool& done);

  /// Runs all tasks of the phase, then step().
  Status stepWhole(bool& done);

  /// Number of tasks in the current phase; 0 with one worker.
  int tasks() const { return phase_ == Phase::kIdle ? 0 : task_count_; }
  /// Largest number of tasks in a phase with this number of workers.
  static int mostTasks(int workers) { return workers > 1 ? kTasksPerWorker * workers : 0; }
  /// Runs a task, each exactly once before the step. Calls at the same time need different
  /// tasks and different workers.
  void runTask(int task, int worker);

 private:
  enum class Phase : std::uint8_t { kIdle, kVertices, kFaces, kBands };
  static constexpr int kFullBand_px = 1024;  ///< width of the widest band of kBandRows
  /// Several tasks per worker balance the load between parts of the image.
  static constexpr int kTasksPerWorker = 4;
  /// Bands in a row that one worker draws, and their edge pixels until all are known.
  struct Block {
    int worker = 0;
    std::int32_t first = 0;  ///< of the worker's edge pixels
    std::int32_t count = 0;
    bool complete = false;
  };
  /// Data of one worker.
  struct Worker {
    BandPainter painter;
    std::span<PackedEdgePixel> pixels;
    std::int32_t pixel_count = 0;
  };

  void createWorkers(int workers, int max_pixels, const RenderOptions& options, Arena& kept,
                     Arena& scratch);
  std::size_t itemsOf(Phase phase) const;
  int tasksOf(Phase phase) const;
  void enter(Phase phase);
  Status stepAlone(bool& done);
  void transformOrBin(std::size_t first, std::size_t last, int share);
  Status joinBlocks();
  void findCoveredBands();
  int beginOfBlock(int block) const;
  void drawBlock(int index, int worker);
  BandSource source() const { return {scene_, *rays_, bins_, surfaces_, band_rows_}; }

  CameraScene scene_;
  BandPainter painter_;
  FaceBins bins_;
  int max_width_ = 0;
  int max_height_ = 0;
  int band_rows_ = kBandRows;
  std::span<Worker> workers_;  ///< kept; empty with one worker
  std::span<Block> blocks_;    ///< from the last phase's beginning to its end

  const RayGrid* rays_ = nullptr;
  EdgeRender* output_ = nullptr;
  SurfaceRender surfaces_;
  Phase phase_ = Phase::kIdle;
  std::size_t next_ = 0;  ///< next vertex or face
  bool plain_ = false;
  int task_count_ = 0;
  int covered_first_ = 0;  ///< bands from here on hold faces
  int covered_count_ = 0;
};

}  // namespace boresight
