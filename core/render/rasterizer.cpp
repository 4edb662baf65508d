// SPDX-License-Identifier: Apache-2.0
#include "core/render/rasterizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/nth.h"
#include "core/render/drawn_face.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Faces this narrow are tested pixel by pixel.
constexpr int kNarrow_px = 8;
/// Runs this short are drawn pixel by pixel.
constexpr int kShort_px = 8;
/// Columns that are tested together: inside all edges, outside one, or across some.
constexpr int kChunk_px = 64;
/// Cost of a chunk that the face does not cover.
constexpr int kChunkWork_px = 16;
/// Least uncertainty of the column at which an edge crosses a row.
constexpr double kLeastWidth_px = 1e-6;

/// Columns of a row that may be inside (possible) and that surely are (certain).
struct Span {
  int possible_first, possible_last;
  int certain_first, certain_last;
};

/// Cuts a span by an edge that crosses the row at a column, known to within `width`.
inline void cutAt(double crossing, double width, bool covers_right, int x_first, int x_last,
                  Span& span) {
  const int before = floorClamped(crossing - width, x_first - 1, x_last + 1);
  int after = std::min(before + 1, x_last + 1);
  if (crossing + width > after) after = ceilClamped(crossing + width, x_first - 1, x_last + 1);
  // `before` and `after` lie beyond the slack on either side.
  if (covers_right) {
    span.possible_first = std::max(span.possible_first, before + 1);
    span.certain_first = std::max(span.certain_first, after);
  } else {
    span.possible_last = std::min(span.possible_last, after - 1);
    span.certain_last = std::min(span.certain_last, before);
  }
}

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
  cutAt(crossing, slack * std::abs(columns_per_value) + kLeastWidth_px, rise > 0.0, x_first, x_last,
        span);
}

/// An edge across some rows of a chunk: its values at both ends of the first row, and their
/// changes from row to row.
struct Cut {
  double left, right, left_step, right_step, slack;
};

/// The same where rays are level: the edge's values rise alike along all rows, so that the column
/// of its crossing is linear in the row.
struct LevelCut {
  double crossing, step, width;
  bool covers_right;

  /// False when the edge is too nearly along the rows. Values that are wrong by the slack shift
  /// the crossing by that of one column's rise, and wrong rises by twice as much over the chunk.
  bool set(const Cut& cut, int x_first, int x_last) {
    const double rise = cut.right - cut.left;
    if (!(std::abs(rise) > 64.0 * cut.slack)) return false;
    const double columns_per_value = (x_last - x_first) / rise;
    crossing = x_first - cut.left * columns_per_value;
    step = -cut.left_step * columns_per_value;
    width = 8.0 * cut.slack * std::abs(columns_per_value) + kLeastWidth_px;
    covers_right = rise > 0.0;
    return true;
  }
};

/// One row of the band, from column 0. Where y/z is the same all along the row (kLevel: pinhole),
/// the terms in it are computed once.
template <bool kLevel>
struct RowOfFace {
  const double* ray_x;
  const double* ray_y;
  float* inverse_depth;
  std::int32_t* owner;
  double y = 0.0;
  double plane_term = 0.0;

  RowOfFace(const DrawnFace& drawn, const RasterBand& band, int row) {
    const std::size_t start = band.index(0, row);
    ray_x = band.ray_x.data() + start;
    ray_y = band.ray_y.data() + start;
    inverse_depth = band.inverse_depth.data() + start;
    owner = band.face.data() + start;
    if (!kLevel) return;
    y = ray_y[band.x_begin];
    plane_term = drawn.plane_y * y + drawn.plane_1;
  }
  double edge(const DrawnFace& drawn, int i, int x) const {
    return drawn.a[i] * ray_x[x] + (drawn.b[i] * (kLevel ? y : ray_y[x]) + drawn.c[i]);
  }
  double plane(const DrawnFace& drawn, int x) const {
    return drawn.plane_x * ray_x[x] +
           (kLevel ? plane_term : drawn.plane_y * ray_y[x] + drawn.plane_1);
  }
};

template <bool kLevel, bool kClamped>
class FaceDrawer {
 public:
  FaceDrawer(const DrawnFace& drawn, RasterBand& band) : drawn_(drawn), band_(band) {}

  void drawNarrow(int x_first, int x_last, int row_first, int row_last) const {
    for (int y = row_first; y <= row_last; ++y)
      drawTested(RowOfFace<kLevel>(drawn_, band_, y), x_first, x_last);
  }

  void drawWide(int x_first, int x_last, int row_first, int row_last) const {
    for (int x = x_first; x <= x_last; x += kChunk_px)
      drawChunk(x, std::min(x + kChunk_px - 1, x_last), row_first, row_last);
  }

 private:
  void drawPixel(const RowOfFace<kLevel>& row, int x) const {
    double inverse_depth = row.plane(drawn_, x);
    if (kClamped && !drawn_.clamp(inverse_depth)) return;
    const auto rounded = static_cast<float>(inverse_depth);
    const float before = row.inverse_depth[x];
    if (rounded > before || (rounded == before && drawn_.face < row.owner[x])) {
      row.inverse_depth[x] = rounded;
      row.owner[x] = drawn_.face;
    }
  }

  /// drawPixel for a run, without branches so that several pixels can be drawn at once.
  void drawRun(const RowOfFace<kLevel>& row, int x_first, int x_last) const {
    band_.work_px += x_last - x_first + 1;
    if (kClamped) {
      for (int x = x_first; x <= x_last; ++x) drawPixel(row, x);
      return;
    }
    const double* ray_x = row.ray_x + x_first;
    const double* ray_y = row.ray_y + x_first;
    float* inverse_depth = row.inverse_depth + x_first;
    std::int32_t* owner = row.owner + x_first;
    const double plane_x = drawn_.plane_x;
    const double plane_y = drawn_.plane_y;
    const double plane_1 = drawn_.plane_1;
    const double plane_term = row.plane_term;
    const std::int32_t face = drawn_.face;
    const int count = x_last - x_first + 1;
    if (count < kShort_px) {
      for (int x = x_first; x <= x_last; ++x) drawPixel(row, x);
      return;
    }
    for (int i = 0; i < count; ++i) {
      const auto rounded = static_cast<float>(plane_x * ray_x[i] +
                                              (kLevel ? plane_term : plane_y * ray_y[i] + plane_1));
      const float before = inverse_depth[i];
      const std::int32_t owner_before = owner[i];
      const bool take = (rounded > before) | ((rounded == before) & (face < owner_before));
      inverse_depth[i] = take ? rounded : before;
      owner[i] = take ? face : owner_before;
    }
  }

  void drawTested(const RowOfFace<kLevel>& row, int x_first, int x_last) const {
    int covered = 0;
    for (int x = x_first; x <= x_last; ++x) {
      if (!(row.edge(drawn_, 0, x) >= drawn_.limit[0])) continue;
      if (!(row.edge(drawn_, 1, x) >= drawn_.limit[1])) continue;
      if (!(row.edge(drawn_, 2, x) >= drawn_.limit[2])) continue;
      drawPixel(row, x);
      ++covered;
    }
    band_.work_px += covered;
  }

  void drawSpan(const RowOfFace<kLevel>& row, const Span& span) const {
    if (span.certain_last < span.certain_first) {
      drawTested(row, span.possible_first, span.possible_last);
      return;
    }
    drawTested(row, span.possible_first, span.certain_first - 1);
    drawRun(row, span.certain_first, span.certain_last);
    drawTested(row, span.certain_last + 1, span.possible_last);
  }

  /// The edges' values at both ends of the rows are linear from the first row to the last, within
  /// the slack.
  void drawChunk(int x_first, int x_last, int row_first, int row_last) const {
    band_.work_px += kChunkWork_px;
    const RowOfFace<kLevel> top(drawn_, band_, row_first);
    const RowOfFace<kLevel> bottom(drawn_, band_, row_last);
    const double per_row = row_last > row_first ? 1.0 / (row_last - row_first) : 0.0;
    Cut cuts[3];
    int cut_count = 0;
    for (int i = 0; i < 3; ++i) {
      const double e00 = top.edge(drawn_, i, x_first);
      const double e10 = top.edge(drawn_, i, x_last);
      const double e01 = bottom.edge(drawn_, i, x_first);
      const double e11 = bottom.edge(drawn_, i, x_last);
      const double slack = drawn_.slack[i];
      if (std::max(std::max(e00, e10), std::max(e01, e11)) < -slack) return;
      if (std::min(std::min(e00, e10), std::min(e01, e11)) > slack) continue;
      cuts[cut_count++] = {e00, e10, (e01 - e00) * per_row, (e11 - e10) * per_row, slack};
    }
    LevelCut level_cuts[3];
    bool level = kLevel;
    for (int i = 0; level && i < cut_count; ++i)
      level = level_cuts[i].set(cuts[i], x_first, x_last);
    for (int y = row_first; y <= row_last; ++y) {
      Span span{x_first, x_last, x_first, x_last};
      for (int i = 0; i < cut_count; ++i)
        level ? cutNext(level_cuts[i], x_first, x_last, span)
              : cutNext(cuts[i], x_first, x_last, span);
      if (span.possible_last >= span.possible_first)
        drawSpan(RowOfFace<kLevel>(drawn_, band_, y), span);
    }
  }

  /// Cuts a row's span and goes on to the next row.
  static void cutNext(LevelCut& cut, int x_first, int x_last, Span& span) {
    cutAt(cut.crossing, cut.width, cut.covers_right, x_first, x_last, span);
    cut.crossing += cut.step;
  }
  static void cutNext(Cut& cut, int x_first, int x_last, Span& span) {
    cutSpan(cut.left, cut.right, cut.slack, x_first, x_last, span);
    cut.left += cut.left_step;
    cut.right += cut.right_step;
  }

  const DrawnFace& drawn_;
  RasterBand& band_;
};

/// Largest deviation of the edges' values from linear within a chunk: rays differ from linear by at
/// most bend L^2 / 8 along L pixels; the rest is rounding.
void setSlack(const RayGrid& rays, const RasterBand& band, int x_first, int x_last, int row_first,
              int row_last, DrawnFace& drawn) {
  const int length = std::min(x_last - x_first + 1, kChunk_px);
  const int height = row_last - row_first + 1;
  const double bend = rays.rayBend_per_px2() * (length * length + height * height) * 0.125;
  const double reach = std::max(std::abs(band.ray_x[band.index(x_first, row_first)]),
                                std::abs(band.ray_x[band.index(x_last, row_first)])) +
                       std::abs(band.ray_y[band.index(x_first, row_first)]) + 1.0;
  for (int i = 0; i < 3; ++i)
    drawn.slack[i] = (std::abs(drawn.a[i]) + std::abs(drawn.b[i])) * (bend + 4e-14 * reach) +
                     std::abs(drawn.c[i]) * 4e-14;
}

template <bool kLevel, bool kClamped>
void draw(const DrawnFace& drawn, bool narrow, int x_first, int x_last, int row_first, int row_last,
          RasterBand& band) {
  const FaceDrawer<kLevel, kClamped> drawer(drawn, band);
  if (narrow)
    drawer.drawNarrow(x_first, x_last, row_first, row_last);
  else
    drawer.drawWide(x_first, x_last, row_first, row_last);
}

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
  band.valid = arena.allocate<std::uint8_t>(width);
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
  work_px = 0;
  x_begin = x_first;
  x_end = x_last + 1;
  const int length = x_end - x_begin;
  if (length <= 0) return;
  for (int row = 1; row <= count; ++row) {
    const std::size_t start = index(x_begin, row);
    // Rows of a pinhole camera differ in y/z only.
    const bool alike = rays.level() && row > 1;
    rays.row(y + row - 1, x_begin, alike ? 1 : length, &ray_x[start], &ray_y[start], valid.data());
    if (alike) {
      std::copy_n(&ray_x[index(x_begin, 1)], length, &ray_x[start]);
      std::fill_n(&ray_y[start], length, ray_y[start]);
    }
    float* depth_row = &inverse_depth[start];
    std::int32_t* face_row = &face[start];
    if (rays.smooth()) {
      std::fill_n(depth_row, length, 0.0F);
      std::fill_n(face_row, length, kBackground);
    } else {
      // An infinitely near background keeps surfaces off pixels without a ray.
      for (int i = 0; i < length; ++i) {
        depth_row[i] = nth(valid, i) != 0 ? 0.0F : std::numeric_limits<float>::infinity();
        face_row[i] = nth(valid, i) != 0 ? kBackground : kInvalid;
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
  if (!prepareFace(scene, face, drawn)) return;
  // With pixels without a ray in the image, the ends of a run do not bound its pixels.
  const bool narrow = x_last - x_first < kNarrow_px || !rays.smooth();
  if (!narrow) setSlack(rays, band, x_first, x_last, row_first, row_last, drawn);
  const auto draw_as = rays.level() ? (drawn.clamped ? draw<true, true> : draw<true, false>)
                                    : (drawn.clamped ? draw<false, true> : draw<false, false>);
  draw_as(drawn, narrow, x_first, x_last, row_first, row_last, band);
}

}  // namespace boresight
