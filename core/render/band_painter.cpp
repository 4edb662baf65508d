// SPDX-License-Identifier: Apache-2.0
#include "core/render/band_painter.h"

#include <algorithm>

namespace boresight {
namespace {

/// Faces drawn in one step, wide ones counting several times: some milliseconds on the ground.
constexpr int kDrawnSlice = 16384;

/// Columns covered in bands band - before .. band + after, and `before + after` more on both sides,
/// within the image.
FaceBins::Columns columnsAround(const BandSource& source, int band, int before, int after) {
  FaceBins::Columns columns;
  for (int i = std::max(band - before, 0); i <= std::min(band + after, source.bands() - 1); ++i)
    columns.include(source.bins.columns(i).first, source.bins.columns(i).last);
  if (columns.last < columns.first) return columns;
  const int margin = before + after;
  const int last_column = source.rays.camera().width - 1;
  columns.first = static_cast<std::int16_t>(std::max(columns.first - margin, 0));
  columns.last = static_cast<std::int16_t>(std::min(columns.last + margin, last_column));
  return columns;
}

}  // namespace

BandPainter BandPainter::create(int max_width, int band_rows, Arena& arena) {
  BandPainter painter;
  painter.raster_ = RasterBand::create(max_width, band_rows, arena);
  painter.salient_edges_ = SalientEdges::create(max_width, arena);
  return painter;
}

void BandPainter::begin(const BandSource& source, int first_band, int end_band,
                        EdgeRender& output) {
  const int height = source.rays.camera().height;
  const int first_row = firstRow(first_band, source.band_rows);
  const int end_row = end_band < source.bands() ? firstRow(end_band, source.band_rows) : height;
  salient_edges_.begin(first_row, end_row - 1);
  raster_.rows = 0;
  raster_.x_begin = 0;
  raster_.x_end = 0;
  band_ = first_band;
  end_band_ = end_band;
  open_ = false;
  if (first_band == 0) return;
  // The row to begin with also depends on the one above it.
  open(source, first_band - 1, first_row - 1, 2);
  while (!drawSome(source)) {
  }
  open_ = false;
  const FaceBins::Columns compared = columnsAround(source, first_band - 1, 1, 0);
  salient_edges_.addRowAbove(source.scene, raster_, compared.first, compared.last, output);
}

/// Prepares some rows of a band for drawing.
void BandPainter::open(const BandSource& source, int band, int y, int rows) {
  // Pairs of pixels reach one pixel beyond the faces, and the derivatives of rays there another
  // one; rows at the borders of bands are also used with the neighbouring band.
  const FaceBins::Columns prepared = columnsAround(source, band, 1, 1);
  raster_.advance(source.rays, y, rows, prepared.first, prepared.last);
  open_ = true;
  list_ = 0;
  next_drawn_ = source.bins.firstFace(band, list_);
  drawn_band_ = band;
}

/// Whether more faces than kMostLayers cover the open band. True for some of its rows only if true
/// for all rows.
bool BandPainter::overdrawn(const BandSource& source) const {
  return raster_.work_px > kMostLayers * source.band_rows * source.rays.camera().width;
}

/// Draws faces of the open band; true when all are drawn, or it is overdrawn. Bands that hold very
/// many faces take several slices.
bool BandPainter::drawSome(const BandSource& source) {
  const FaceBins& bins = source.bins;
  int work = 0;
  while (work < kDrawnSlice) {
    if (next_drawn_ < 0) {
      if (++list_ == bins.lists()) return true;
      next_drawn_ = bins.firstFace(drawn_band_, list_);
      continue;
    }
    const std::int32_t face = next_drawn_;
    next_drawn_ = bins.nextFace(face);
    ++work;
    if (list_ >= bins.firstSmallList()) {
      bins.smallFaces().draw(source.scene, face, raster_);
      continue;
    }
    const PixelBounds bounds = faceBounds(source.scene, source.rays, face);
    drawFace(source.scene, source.rays, face, bounds, raster_);
    if (overdrawn(source)) return true;
    work += (bounds.x_last - bounds.x_first) / 16;
  }
  return false;
}

Status BandPainter::step(const BandSource& source, EdgeRender& output, bool& done) {
  const Camera& camera = source.rays.camera();
  done = band_ >= end_band_;
  if (done) return Status::kOk;
  const int y = band_ * source.band_rows;
  if (!open_) open(source, band_, y, std::min(source.band_rows, camera.height - y));
  if (!drawSome(source)) return Status::kOk;
  open_ = false;
  done = overdrawn(source);
  if (done) return Status::kTooManyLayers;
  if (source.surfaces.wanted()) {
    resolveDepths(source.scene, raster_);
    copySurfaces(source.scene, raster_, camera, source.surfaces);
  }
  const FaceBins::Columns compared = columnsAround(source, band_, 1, 0);
  const bool final = y + raster_.rows >= camera.height;
  const Status status =
      salient_edges_.addBand(source.scene, raster_, compared.first, compared.last, final, output);
  ++band_;
  done = status != Status::kOk || band_ == end_band_;
  return status;
}

Status BandPainter::drawAll(const BandSource& source, EdgeRender& output) {
  Status status = Status::kOk;
  for (bool done = false; !done;) status = step(source, output, done);
  return status;
}

}  // namespace boresight
