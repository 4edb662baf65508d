// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/render/camera_scene.h"
#include "core/render/edge_pixel.h"
#include "core/render/rasterizer.h"
#include "core/render/surface_trace.h"

namespace boresight {

/// Finds the salient edges of rendered rows (Pham 2025, Sec. III-B), thin and unbiased: for every
/// pair of neighbouring pixels whose surfaces differ, it finds the exact point between their
/// centres where the nearer surface ends, and marks the pixel nearer to that point.
///
/// A pair differs when the normals differ by more than the threshold of the nearer surface's part,
/// when the depths differ by more than its threshold, or when one side is background. Depths are
/// compared at both pixels, each surface's plane extended to the other: grazing and curved surfaces
/// are no depth edges.
class SalientEdges {
 public:
  /// Takes the memory of one row from `arena`.
  static SalientEdges create(int max_width, Arena& arena);

  /// Clears the output for a render.
  static void clear(EdgeRender& output);

  /// Begins with bands from which rows first_y .. last_y of the image are completed; candidates of
  /// pairs for pixels of other rows are left to the neighbouring bands.
  void begin(int first_y, int last_y);

  /// The pairs between the band's first two new rows: they belong to the lower row, the first to be
  /// completed.
  void addRowAbove(const CameraScene& scene, const RasterBand& band, int x_first, int x_last,
                   EdgeRender& output);

  /// The pairs of a band's rows, columns x_first .. x_last: those within and below each row but the
  /// last, which is left to the next band unless this one is `final`. Rows that are complete are
  /// appended to the output. kCapacityExceeded when its pixels are not enough.
  Status addBand(const CameraScene& scene, const RasterBand& band, int x_first, int x_last,
                 bool final, EdgeRender& output);

 private:
  /// One pixel of a pair.
  struct Sample {
    int x = 0;
    int row = 0;  ///< of the band
    std::int32_t face = -1;
    Eigen::Vector3d ray = Eigen::Vector3d::Zero();
  };
  /// Difference between two surfaces.
  struct Difference {
    bool nearer_is_p = true;
    bool crease = false;
    bool occluding = false;
  };
  /// The crossing between two pixels.
  struct Crossing {
    double s = 0.0;  ///< position on the way from p (0) to q (1)
    bool nearer_is_p = true;
    std::int32_t face = -1;  ///< of the nearer surface, where it ends
    bool has_line = false;
    Eigen::Vector3d line = Eigen::Vector3d::Zero();  ///< line . ray > 0 on the nearer side
    std::int32_t edge_of = -1;                       ///< the face whose edge the line is; -1: none
    std::int8_t edge = -1;
    std::uint8_t kind = 0;
  };
  struct Context {
    const CameraScene& scene;
    const RasterBand& band;
    EdgeRender& output;
  };

  void compareWithin(const Context& context, int row, int x_first, int x_last);
  void compareBelow(const Context& context, int row, int x_first, int x_last);
  void comparePair(const Context& context, int x_p, int row_p, int x_q, int row_q);
  bool surfacesDiffer(const Context& context, std::size_t p, std::size_t q, Difference& difference);
  bool crossBorder(const Context& context, const Sample& p, const Sample& q, Crossing& crossing);
  bool crossSurfaces(const Context& context, const Sample& p, const Sample& q,
                     const Difference& difference, Crossing& crossing);
  bool crossOverlap(const Context& context, const Sample& p, const Sample& q,
                    const SurfaceEnd& end_p, const SurfaceEnd& end_q, Crossing& crossing);
  static Eigen::Vector3d lineAt(const Context& context, const Crossing& crossing, int x, int y);
  void mark(const Context& context, const Sample& p, const Sample& q, const Crossing& crossing);
  float depthOf(const Context& context, const Sample& own, const Sample& marked,
                const Eigen::Vector3d& ray_at_line, std::int32_t face);
  Status finishRow(const Context& context, int row);
  void endRows(int y, EdgeRender& output) const;

  FaceCache faces_;
  std::span<EdgePixel> candidates_;  ///< two rows: this one and the next
  int stride_ = 0;
  int first_y_ = 0;
  int last_y_ = 0;
};

}  // namespace boresight
