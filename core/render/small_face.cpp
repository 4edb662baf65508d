// SPDX-License-Identifier: Apache-2.0
#include "core/render/small_face.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
  const Face& indices = scene.mesh.faces[static_cast<std::size_t>(face)];
  const std::uint16_t a = scene.vertex_depth[static_cast<std::size_t>(indices.vertex[0])];
  const std::uint16_t b = scene.vertex_depth[static_cast<std::size_t>(indices.vertex[1])];
  const std::uint16_t c = scene.vertex_depth[static_cast<std::size_t>(indices.vertex[2])];
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
    return hasArea() && insideFace(drawn_, band_.ray_x[at], band_.ray_y[at]) && isVisible();
  }

  bool hasArea() {
    if (!edges_known_) has_area_ = prepareEdges(scene_, face_, drawn_);
    edges_known_ = true;
    return has_area_;
  }

  bool isVisible() {
    if (!plane_known_) visible_ = preparePlane(scene_, face_, drawn_);
    plane_known_ = true;
    return visible_;
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
    if (!hasArea() || !isVisible() ||
        !inverseDepthOn(drawn_, band_.ray_x[at], band_.ray_y[at], inverse_depth))
      return;
    if (band_.inverse_depth[at] == RasterBand::kUnknownDepth) {
      if (!owner_prepared_) owner_visible_ = prepareFace(scene_, owner_, owner_drawn_);
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
  bool edges_known_ = false;
  bool has_area_ = false;
  bool plane_known_ = false;
  bool visible_ = false;
  bool depth_known_ = false;
  bool owner_prepared_ = false;
  bool owner_visible_ = false;
  DepthRange depth_;
  DrawnFace drawn_;
  DrawnFace owner_drawn_;
};

/// A row of pixels and the values of a face's lines at its first one.
struct FixedRow {
  std::size_t first;  ///< entry of the band
  int count;
  int ab, bc;
  int ab_per_px, bc_per_px;
  int tolerance;
};

/// A row of a face so thin that its lines' values may all be within the tolerance.
void drawThinRow(const FixedFace& fixed, const FixedRow& row, SmallFace& small) {
  int ab = row.ab;
  int bc = row.bc;
  for (int i = 0; i < row.count; ++i, ab += row.ab_per_px, bc += row.bc_per_px) {
    const int located = FixedFace::locate(ab, bc, fixed.area2() - ab - bc, row.tolerance);
    if (located >= 0) small.visit(row.first + static_cast<std::size_t>(i), located > 0);
  }
}

/// A row of a face whose area is more than three tolerances, so that the values of its lines cannot
/// all be within the tolerance on the outer side: outside, one is below -tolerance; surely inside,
/// all are above the tolerance. Values of a face seen from inside have the other sign.
void drawClearRow(const FixedFace& fixed, const FixedRow& row, SmallFace& small) {
  const int sign = fixed.area2() < 0 ? -1 : 1;
  const int ab_per_px = sign * row.ab_per_px;
  const int bc_per_px = sign * row.bc_per_px;
  const int ca_per_px = -ab_per_px - bc_per_px;
  const int surely = 2 * row.tolerance + 1;
  int ab = sign * row.ab + row.tolerance;
  int bc = sign * row.bc + row.tolerance;
  int ca = sign * (fixed.area2() - row.ab - row.bc) + row.tolerance;
  bool entered = false;
  for (int i = 0; i < row.count; ++i, ab += ab_per_px, bc += bc_per_px, ca += ca_per_px) {
    if ((ab | bc | ca) >= 0) {
      entered = true;
      const bool inside = ((ab - surely) | (bc - surely) | (ca - surely)) >= 0;
      small.visit(row.first + static_cast<std::size_t>(i), inside);
    } else if (entered) {
      return;  // a face is convex
    }
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
  const Face& indices = scene.mesh.faces[static_cast<std::size_t>(face)];
  const FixedFace fixed(scene.vertex_px[static_cast<std::size_t>(indices.vertex[0])],
                        scene.vertex_px[static_cast<std::size_t>(indices.vertex[1])],
                        scene.vertex_px[static_cast<std::size_t>(indices.vertex[2])]);
  PixelBox box = this->box(fixed);
  const int top = band.first_y - scale_.middle_y;
  box.x_first = std::max(box.x_first, band.x_begin - scale_.middle_x);
  box.x_last = std::min(box.x_last, band.x_end - 1 - scale_.middle_x);
  box.y_first = std::max(box.y_first, top);
  box.y_last = std::min(box.y_last, top + band.rows - 1);
  if (box.x_last < box.x_first) return;

  SmallFace small(scene, face, band);
  const int steps = scale_.steps();
  FixedRow row;
  row.count = box.x_last - box.x_first + 1;
  row.ab_per_px = -(fixed.b_y - fixed.a_y) * steps;
  row.bc_per_px = -(fixed.c_y - fixed.b_y) * steps;
  row.tolerance = tolerance(fixed);
  const bool clear = std::abs(fixed.area2()) > 3 * row.tolerance;
  for (int y = box.y_first; y <= box.y_last; ++y) {
    row.first = band.index(box.x_first + scale_.middle_x, y - top + 1);
    row.ab = fixed.lineAb(box.x_first * steps, y * steps);
    row.bc = fixed.lineBc(box.x_first * steps, y * steps);
    if (clear)
      drawClearRow(fixed, row, small);
    else
      drawThinRow(fixed, row, small);
  }
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
