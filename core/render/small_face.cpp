// SPDX-License-Identifier: Apache-2.0
#include "core/render/small_face.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/nth.h"
#include "core/render/drawn_face.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Depths of a face's vertices.
struct DepthRange {
  int low = 0;
  int high = 0;
};

DepthRange depthRange(const CameraScene& scene, std::int32_t face) {
  const Face indices = nth(scene.mesh.faces, face);
  const std::uint16_t a = nth(scene.vertex_depth, indices.vertex[0]);
  const std::uint16_t b = nth(scene.vertex_depth, indices.vertex[1]);
  const std::uint16_t c = nth(scene.vertex_depth, indices.vertex[2]);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

/// The current face: the data of exact tests is computed at most once, also for the face tested
/// last.
class SmallFace {
 public:
  SmallFace(const CameraScene& scene, std::int32_t face, RasterBand& band)
      : scene_(scene), band_(band), face_(face) {}

  /// Draws a pixel that the face may cover; `inside`: surely does.
  void visit(std::size_t at, bool inside) {
    const std::int32_t owner = band_.face[at];
    if (owner >= 0 && owner != owner_) meet(owner);
    const Relation relation = owner < 0 ? Relation::kNearer : relation_;
    // Whether a hidden pixel is covered makes no difference.
    if (relation == Relation::kFarther || !(inside || covers(at))) return;
    if (relation == Relation::kNearer) return take(at);
    contest(at);
  }

 private:
  enum class Relation : std::uint8_t { kNearer, kFarther, kUnclear };

  void take(std::size_t at) {
    band_.face[at] = face_;
    band_.inverse_depth[at] = RasterBand::kUnknownDepth;
  }

  /// By the exact edges. The plane of a face that covers no pixel is not needed.
  bool covers(std::size_t at) {
    if (!edges_known_) has_area_ = prepareEdges(corners(), drawn_);
    edges_known_ = true;
    return has_area_ && insideFace(drawn_, band_.ray_x[at], band_.ray_y[at]) && isVisible();
  }

  bool isVisible() {
    if (!plane_known_) visible_ = preparePlane(corners(), face_, drawn_);
    plane_known_ = true;
    return visible_;
  }

  const Corners& corners() {
    if (!corners_known_) corners_ = scene_.corners(face_);
    corners_known_ = true;
    return corners_;
  }

  void meet(std::int32_t owner) {
    owner_ = owner;
    owner_prepared_ = false;
    if (!depth_known_) depth_ = depthRange(scene_, face_);
    depth_known_ = true;
    const DepthRange owner_depth = depthRange(scene_, owner);
    relation_ = depth_.low >= owner_depth.high + scene_.scale.gap   ? Relation::kFarther
                : owner_depth.low >= depth_.high + scene_.scale.gap ? Relation::kNearer
                                                                    : Relation::kUnclear;
  }

  /// Neither is clearly nearer: as the rasterizer compares.
  void contest(std::size_t at) {
    float inverse_depth = 0.0F;
    if (!isVisible() || !inverseDepthOn(drawn_, band_.ray_x[at], band_.ray_y[at], inverse_depth))
      return;
    if (band_.inverse_depth[at] == RasterBand::kUnknownDepth) {
      if (!owner_prepared_)
        owner_visible_ = preparePlane(scene_.corners(owner_), owner_, owner_drawn_);
      owner_prepared_ = true;
      float known = 0.0F;
      if (owner_visible_ && inverseDepthOn(owner_drawn_, band_.ray_x[at], band_.ray_y[at], known))
        band_.inverse_depth[at] = known;
    }
    const float before = band_.inverse_depth[at];
    if (inverse_depth > before || (inverse_depth == before && face_ < owner_)) {
      band_.inverse_depth[at] = inverse_depth;
      band_.face[at] = face_;
    }
  }

  const CameraScene& scene_;
  RasterBand& band_;
  std::int32_t face_;
  std::int32_t owner_ = -1;  ///< the face tested last
  Relation relation_ = Relation::kUnclear;
  bool corners_known_ = false;
  bool edges_known_ = false;
  bool has_area_ = false;
  bool plane_known_ = false;
  bool visible_ = false;
  bool depth_known_ = false;
  bool owner_prepared_ = false;
  bool owner_visible_ = false;
  DepthRange depth_;
  Corners corners_;
  DrawnFace drawn_;
  DrawnFace owner_drawn_;
};

/// The value of a line of a face at a pixel, and its steps to the next pixel and row.
struct LineValue {
  int value;
  int per_px;
  int per_row;
};

/// The pixels of a face's box, and its lines at the first one; the third value follows from the
/// area.
struct FixedArea {
  std::size_t first;  ///< entry of the band
  std::size_t stride;
  int columns, rows;
  LineValue ab, bc;
  int area2;
  int tolerance;
};

/// Draws a face so thin that its lines' values may all be within the tolerance.
void drawThin(const FixedArea& area, SmallFace& small) {
  for (int row = 0; row < area.rows; ++row) {
    const std::size_t first = area.first + static_cast<std::size_t>(row) * area.stride;
    int ab = area.ab.value + row * area.ab.per_row;
    int bc = area.bc.value + row * area.bc.per_row;
    for (int i = 0; i < area.columns; ++i, ab += area.ab.per_px, bc += area.bc.per_px) {
      const int located = FixedFace::locate(ab, bc, area.area2 - ab - bc, area.tolerance);
      if (located >= 0) small.visit(first + static_cast<std::size_t>(i), located > 0);
    }
  }
}

/// Draws a face whose area is more than three tolerances, so that the values of its lines cannot
/// all be within the tolerance on the outer side: outside, one is below -tolerance; surely inside,
/// all are above the tolerance. Values of a face seen from inside have the other sign.
void drawClear(const FixedArea& area, SmallFace& small) {
  const int sign = area.area2 < 0 ? -1 : 1;
  const int ab_per_px = sign * area.ab.per_px;
  const int bc_per_px = sign * area.bc.per_px;
  const int ca_per_px = -ab_per_px - bc_per_px;
  const int surely = 2 * area.tolerance + 1;
  int row_ab = sign * area.ab.value + area.tolerance;
  int row_bc = sign * area.bc.value + area.tolerance;
  const int sum = sign * area.area2 + 3 * area.tolerance;
  std::size_t first = area.first;
  for (int row = 0; row < area.rows; ++row, first += area.stride) {
    int ab = row_ab;
    int bc = row_bc;
    int ca = sum - ab - bc;
    const std::size_t end = first + static_cast<std::size_t>(area.columns);
    std::size_t at = first;
    const auto isOutside = [&] { return (ab | bc | ca) < 0; };
    const auto next = [&] {
      ++at;
      ab += ab_per_px;
      bc += bc_per_px;
      ca += ca_per_px;
    };
    while (at < end && isOutside()) next();
    for (; at < end && !isOutside(); next())  // a face is convex
      small.visit(at, ((ab - surely) | (bc - surely) | (ca - surely)) >= 0);
    row_ab += sign * area.ab.per_row;
    row_bc += sign * area.bc.per_row;
  }
}

}  // namespace

SmallFaces::SmallFaces(const CameraScene& scene, const RayGrid& rays) : scale_(scene.scale) {
  // Lines bend by at most k L^2 / 8; twice that, in steps.
  constexpr double kLength2 = 2.0 * kLargest_px * kLargest_px;
  const double bend = 0.25 * rays.lineBend_per_px() * kLength2 * scale_.steps();
  bend_ = ceilClamped(8.0 * bend, 0, 64);
  slack_ = 1 + (bend_ + 7) / 8;
  largest_ = kLargest_px * scale_.steps();
  possible_ = rays.smooth() && bend <= 8.0;
}

void SmallFaces::draw(const CameraScene& scene, std::int32_t face, RasterBand& band) const {
  const Face indices = nth(scene.mesh.faces, face);
  const FixedFace fixed(nth(scene.vertex_px, indices.vertex[0]),
                        nth(scene.vertex_px, indices.vertex[1]),
                        nth(scene.vertex_px, indices.vertex[2]));
  PixelBox box = this->box(fixed);
  const int top = band.first_y - scale_.middle_y;
  box.x_first = std::max(box.x_first, band.x_begin - scale_.middle_x);
  box.x_last = std::min(box.x_last, band.x_end - 1 - scale_.middle_x);
  box.y_first = std::max(box.y_first, top);
  box.y_last = std::min(box.y_last, top + band.rows - 1);
  if (box.x_last < box.x_first) return;

  SmallFace small(scene, face, band);
  const int steps = scale_.steps();
  const int x = box.x_first * steps;
  const int y = box.y_first * steps;
  if (box.x_first == box.x_last && box.y_first == box.y_last) {
    const int located = FixedFace::locate(fixed.lineAb(x, y), fixed.lineBc(x, y),
                                          fixed.area2() - fixed.lineAb(x, y) - fixed.lineBc(x, y),
                                          tolerance(fixed));
    const std::size_t at = band.index(box.x_first + scale_.middle_x, box.y_first - top + 1);
    if (located >= 0) small.visit(at, located > 0);
    return;
  }
  const FixedArea area{
      band.index(box.x_first + scale_.middle_x, box.y_first - top + 1),
      static_cast<std::size_t>(band.stride),
      box.x_last - box.x_first + 1,
      box.y_last - box.y_first + 1,
      {fixed.lineAb(x, y), -(fixed.b_y - fixed.a_y) * steps, (fixed.b_x - fixed.a_x) * steps},
      {fixed.lineBc(x, y), -(fixed.c_y - fixed.b_y) * steps, (fixed.c_x - fixed.b_x) * steps},
      fixed.area2(),
      tolerance(fixed)};
  if (std::abs(area.area2) > 3 * area.tolerance)
    drawClear(area, small);
  else
    drawThin(area, small);
}

void resolveDepths(const CameraScene& scene, RasterBand& band) {
  for (int row = 1; row <= band.rows; ++row)
    for (int x = band.x_begin; x < band.x_end; ++x) {
      const std::size_t at = band.index(x, row);
      DrawnFace drawn;
      float inverse_depth = 0.0F;
      if (band.inverse_depth[at] == RasterBand::kUnknownDepth &&
          prepareFace(scene, band.face[at], drawn) &&
          inverseDepthOn(drawn, band.ray_x[at], band.ray_y[at], inverse_depth))
        band.inverse_depth[at] = inverse_depth;
    }
}

}  // namespace boresight
