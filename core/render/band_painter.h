// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/render/camera_scene.h"
#include "core/render/edge_pixel.h"
#include "core/render/face_bins.h"
#include "core/render/rasterizer.h"
#include "core/render/ray_grid.h"
#include "core/render/salient_edges.h"
#include "core/render/surface_render.h"

namespace boresight {

/// Input of a render, the same for all its bands.
struct BandSource {
  const CameraScene& scene;       ///< the mesh from the pose
  const RayGrid& rays;            ///< of the camera
  const FaceBins& bins;           ///< the faces of each band
  const SurfaceRender& surfaces;  ///< optional further outputs
  int band_rows;                  ///< rows of a band

  /// Bands of the image.
  int bands() const { return (rays.camera().height - 1) / band_rows + 1; }
};

/// Draws bands of rows one after the other and finds their salient edges; memory is one band. A
/// render may be divided among several painters, each with consecutive bands: the result of a row
/// does not depend on the division.
class BandPainter {
 public:
  /// Faces that may cover the pixels of a band, on average over the image's width. Meshes of real
  /// surfaces stay far below; without a bound the time of a render could grow with faces times
  /// pixels.
  static constexpr std::int64_t kMostLayers = 512;

  /// Takes the memory of one band from `arena`.
  static BandPainter create(int max_width, int band_rows, Arena& arena);

  /// Begins with bands `first_band` ... end_band - 1, whose rows in `output` are clear. A row is
  /// complete when the next one is drawn: the painter completes the last row before its first band,
  /// and its own last row only at the end of the image. Bands of a single row cannot be divided.
  void begin(const BandSource& source, int first_band, int end_band, EdgeRender& output);
  /// One slice: a band, or a part of one that holds very many faces; `done` when all bands are.
  /// Complete rows are appended to the output. kCapacityExceeded (output full) and kTooManyLayers
  /// set `done`; the rows before are valid.
  Status step(const BandSource& source, EdgeRender& output, bool& done);

  /// All remaining slices.
  Status drawAll(const BandSource& source, EdgeRender& output);
  /// The first row that a painter of bands from `first_band` on completes.
  static int firstRow(int first_band, int band_rows) {
    return first_band > 0 ? first_band * band_rows - 1 : 0;
  }

 private:
  void open(const BandSource& source, int band, int y, int rows);
  bool drawSome(const BandSource& source);
  bool overdrawn(const BandSource& source) const;

  RasterBand raster_;
  SalientEdges salient_edges_;
  int band_ = 0;  ///< next band
  int end_band_ = 0;
  bool open_ = false;
  int drawn_band_ = 0;            ///< the open one
  int list_ = 0;                  ///< of its faces
  std::int32_t next_drawn_ = -1;  ///< next face of that list
};

}  // namespace boresight
