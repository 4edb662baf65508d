// SPDX-License-Identifier: Apache-2.0
#include "core/render/rasterizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Faces this narrow are tested pixel by pixel.
constexpr int kNarrow_px = 8;
/// Columns that are tested together: inside all edges, outside one, or across some.
constexpr int kChunk_px = 64;

/// A face ready to be drawn.
struct DrawnFace {
  double a[3], b[3], c[3];  ///< edge i: (a x/z + b y/z) + c
  double limit[3];          ///< inside when the edge's value reaches this
  double slack[3];          ///< how far an edge's value may be from linear within a chunk's row
  double plane_x, plane_y, plane_1;
  double low, high;  ///< range of 1/z over the face
  double nearest;    ///< 1/z of the near plane
  std::int32_t face;
};

/// The line a x + b y + c = 0 belongs to the face on its positive side, or to the other one: a rule
/// that changes with the line's sign.
bool ownsLine(const Eigen::Vector3d& edge) {
  if (edge.x() != 0.0) return edge.x() > 0.0;
  if (edge.y() != 0.0) return edge.y() > 0.0;
  return edge.z() > 0.0;
}

bool setUp(const CameraScene& scene, std::int32_t face, DrawnFace& drawn) {
  Eigen::Vector3d edge[3];
  Eigen::Vector3d plane;
  if (!faceEdges(scene, face, edge) || !facePlane(scene, face, plane)) return false;
  for (int i = 0; i < 3; ++i) {
    drawn.a[i] = edge[i].x();
    drawn.b[i] = edge[i].y();
    drawn.c[i] = edge[i].z();
    drawn.limit[i] = ownsLine(edge[i]) ? 0.0 : std::numeric_limits<double>::denorm_min();
  }
  drawn.plane_x = plane.x();
  drawn.plane_y = plane.y();
  drawn.plane_1 = plane.z();
  const double z0 = scene.vertex(face, 0).z();
  const double z1 = scene.vertex(face, 1).z();
  const double z2 = scene.vertex(face, 2).z();
  const double z_min = std::min({z0, z1, z2});
  const double z_max = std::max({z0, z1, z2});
  if (!(z_max >= scene.near_plane_m)) return false;
  // Within a face 1/z stays in this range; the plane of a sliver is not known that well.
  drawn.nearest = 1.0 / scene.near_plane_m;
  drawn.low = 1.0 / z_max;
  drawn.high = z_min > scene.near_plane_m ? 1.0 / z_min : 2.0 * drawn.nearest;
  drawn.face = face;
  return true;
}

/// One row of the band, from column 0.
struct BandRow {
  const double* ray_x;
  const double* ray_y;
  float* inverse_depth;
  std::int32_t* face;
};

inline void drawPixel(const DrawnFace& drawn, const BandRow& row, int x) {
  double inverse_depth =
      (drawn.plane_x * row.ray_x[x] + drawn.plane_y * row.ray_y[x]) + drawn.plane_1;
  inverse_depth = inverse_depth < drawn.low ? drawn.low : inverse_depth;
  inverse_depth = inverse_depth > drawn.high ? drawn.high : inverse_depth;
  const auto rounded = static_cast<float>(inverse_depth);
  if (rounded < row.inverse_depth[x] || inverse_depth > drawn.nearest) return;
  if (rounded == row.inverse_depth[x] && row.face[x] < drawn.face) return;
  row.inverse_depth[x] = rounded;
  row.face[x] = drawn.face;
}

inline void drawTested(const DrawnFace& drawn, const BandRow& row, int x_first, int x_last) {
  for (int x = x_first; x <= x_last; ++x) {
    const double ray_x = row.ray_x[x];
    const double ray_y = row.ray_y[x];
    if (!((drawn.a[0] * ray_x + drawn.b[0] * ray_y) + drawn.c[0] >= drawn.limit[0])) continue;
    if (!((drawn.a[1] * ray_x + drawn.b[1] * ray_y) + drawn.c[1] >= drawn.limit[1])) continue;
    if (!((drawn.a[2] * ray_x + drawn.b[2] * ray_y) + drawn.c[2] >= drawn.limit[2])) continue;
    drawPixel(drawn, row, x);
  }
}

/// Columns of a row that may be inside (possible) and that surely are (certain).
struct Span {
  int possible_first, possible_last;
  int certain_first, certain_last;
};

/// Cuts a span by one edge, whose values at the ends of columns x_first .. x_last are given.
inline void cutSpan(double left, double right, double slack, int x_first, int x_last, Span& span) {
  if (left > slack && right > slack) return;
  if (left < -slack && right < -slack) {
    span.possible_last = span.possible_first - 1;
    span.certain_last = span.certain_first - 1;
    return;
  }
  const double rise = right - left;
  if (!(std::abs(rise) > 4.0 * slack)) {  // along the row: every pixel has to be tested
    span.certain_last = span.certain_first - 1;
    return;
  }
  const double columns_per_value = (x_last - x_first) / rise;
  const double crossing = x_first - left * columns_per_value;
  const double width = slack * std::abs(columns_per_value) + 1e-6;
  const int before = floorClamped(crossing - width, x_first - 1, x_last + 1);
  const int after = ceilClamped(crossing + width, x_first - 1, x_last + 1);
  if (rise > 0.0) {
    span.possible_first = std::max(span.possible_first, before);
    span.certain_first = std::max(span.certain_first, after);
  } else {
    span.possible_last = std::min(span.possible_last, after);
    span.certain_last = std::min(span.certain_last, before);
  }
}

inline void drawSpan(const DrawnFace& drawn, const BandRow& row, const Span& span) {
  if (span.certain_last < span.certain_first) {
    drawTested(drawn, row, span.possible_first, span.possible_last);
    return;
  }
  drawTested(drawn, row, span.possible_first, span.certain_first - 1);
  for (int x = span.certain_first; x <= span.certain_last; ++x) drawPixel(drawn, row, x);
  drawTested(drawn, row, span.certain_last + 1, span.possible_last);
}

class FaceDrawer {
 public:
  FaceDrawer(const DrawnFace& drawn, RasterBand& band) : drawn_(drawn), band_(band) {}

  void drawNarrow(int x_first, int x_last, int row_first, int row_last) const {
    for (int row = row_first; row <= row_last; ++row)
      drawTested(drawn_, bandRow(row), x_first, x_last);
  }

  void drawWide(int x_first, int x_last, int row_first, int row_last, bool reject) const {
    for (int x = x_first; x <= x_last; x += kChunk_px)
      drawChunk(x, std::min(x + kChunk_px - 1, x_last), row_first, row_last, reject);
  }

 private:
  BandRow bandRow(int row) const {
    const std::size_t start = band_.index(0, row);
    return {band_.ray_x.data() + start, band_.ray_y.data() + start,
            band_.inverse_depth.data() + start, band_.face.data() + start};
  }

  double edgeAt(int i, const BandRow& row, int x) const {
    return (drawn_.a[i] * row.ray_x[x] + drawn_.b[i] * row.ray_y[x]) + drawn_.c[i];
  }

  void drawChunk(int x_first, int x_last, int row_first, int row_last, bool reject) const {
    bool inside[3] = {false, false, false};
    if (reject) {
      const BandRow top = bandRow(row_first);
      const BandRow bottom = bandRow(row_last);
      for (int i = 0; i < 3; ++i) {
        const double e00 = edgeAt(i, top, x_first);
        const double e10 = edgeAt(i, top, x_last);
        const double e01 = edgeAt(i, bottom, x_first);
        const double e11 = edgeAt(i, bottom, x_last);
        const double slack = 2.0 * drawn_.slack[i];
        if (std::max(std::max(e00, e10), std::max(e01, e11)) < -slack) return;
        inside[i] = std::min(std::min(e00, e10), std::min(e01, e11)) > slack;
      }
    }
    for (int y = row_first; y <= row_last; ++y) {
      const BandRow row = bandRow(y);
      Span span{x_first, x_last, x_first, x_last};
      for (int i = 0; i < 3; ++i)
        if (!inside[i])
          cutSpan(edgeAt(i, row, x_first), edgeAt(i, row, x_last), drawn_.slack[i], x_first, x_last,
                  span);
      drawSpan(drawn_, row, span);
    }
  }

  const DrawnFace& drawn_;
  RasterBand& band_;
};

}  // namespace

RasterBand RasterBand::create(int width, int rows, Arena& arena) {
  RasterBand band;
  band.stride = width;
  band.capacity_rows = rows + 1;
  const std::size_t pixels =
      static_cast<std::size_t>(band.capacity_rows) * static_cast<std::size_t>(width);
  band.ray_x = arena.allocate<double>(pixels);
  band.ray_y = arena.allocate<double>(pixels);
  band.inverse_depth = arena.allocate<float>(pixels);
  band.face = arena.allocate<std::int32_t>(pixels);
  band.valid = arena.allocate<std::uint8_t>(static_cast<std::size_t>(width));
  return band;
}

void RasterBand::advance(const RayGrid& rays, int y, int count, int x_first, int x_last) {
  const int last = rows;
  if (last > 0 && x_end > x_begin) {
    const auto length = static_cast<std::size_t>(x_end - x_begin);
    const std::size_t to = index(x_begin, 0);
    const std::size_t from = index(x_begin, last);
    std::copy_n(&ray_x[from], length, &ray_x[to]);
    std::copy_n(&ray_y[from], length, &ray_y[to]);
    std::copy_n(&inverse_depth[from], length, &inverse_depth[to]);
    std::copy_n(&face[from], length, &face[to]);
  }
  first_y = y;
  rows = count;
  x_begin = x_first;
  x_end = x_last + 1;
  const int length = x_end - x_begin;
  if (length <= 0) return;
  for (int row = 1; row <= count; ++row) {
    const std::size_t start = index(x_begin, row);
    rays.row(y + row - 1, x_begin, length, &ray_x[start], &ray_y[start], valid.data());
    float* depth_row = &inverse_depth[start];
    std::int32_t* face_row = &face[start];
    if (rays.smooth()) {
      std::fill_n(depth_row, length, 0.0F);
      std::fill_n(face_row, length, kBackground);
    } else {
      // An infinitely near nothing keeps surfaces off pixels without a ray.
      for (int i = 0; i < length; ++i) {
        depth_row[i] =
            valid[static_cast<std::size_t>(i)] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
        face_row[i] = valid[static_cast<std::size_t>(i)] != 0 ? kBackground : kInvalid;
      }
    }
  }
}

void drawFace(const CameraScene& scene, const RayGrid& rays, std::int32_t face,
              const PixelBounds& bounds, RasterBand& band) {
  const int x_first = std::max(bounds.x_first, band.x_begin);
  const int x_last = std::min(bounds.x_last, band.x_end - 1);
  const int row_first = std::max(bounds.y_first - band.first_y, 0) + 1;
  const int row_last = std::min(bounds.y_last - band.first_y, band.rows - 1) + 1;
  if (x_last < x_first || row_last < row_first) return;

  DrawnFace drawn;
  if (!setUp(scene, face, drawn)) return;
  const FaceDrawer drawer(drawn, band);
  const int width = x_last - x_first + 1;
  if (width <= kNarrow_px || !rays.smooth()) {
    drawer.drawNarrow(x_first, x_last, row_first, row_last);
    return;
  }
  // Rays differ from linear by at most bend L^2 / 8 along L pixels; the rest is rounding.
  const int length = std::min(width, kChunk_px);
  const int height = row_last - row_first + 1;
  const double bend = rays.rayBend_per_px2() * (length * length + height * height) * 0.125;
  const double reach = std::max(std::abs(band.ray_x[band.index(x_first, row_first)]),
                                std::abs(band.ray_x[band.index(x_last, row_first)])) +
                       std::abs(band.ray_y[band.index(x_first, row_first)]) + 1.0;
  for (int i = 0; i < 3; ++i)
    drawn.slack[i] = (std::abs(drawn.a[i]) + std::abs(drawn.b[i])) * (bend + 1e-14 * reach) +
                     std::abs(drawn.c[i]) * 1e-14;
  drawer.drawWide(x_first, x_last, row_first, row_last, width > kChunk_px);
}

}  // namespace boresight
