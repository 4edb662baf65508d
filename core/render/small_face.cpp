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

void resolveDepth(const CameraScene& scene, RasterBand& band, std::size_t at) {
  if (band.inverse_depth[at] != RasterBand::kUnknownDepth) return;
  DrawnFace drawn;
  float inverse_depth = 0.0F;
  if (prepareFace(scene, band.face[at], drawn) &&
      inverseDepthOn(drawn, band.ray_x[at], band.ray_y[at], inverse_depth))
    band.inverse_depth[at] = inverse_depth;
}

/// The face at hand: what exact answers need is computed at most once.
class SmallFace {
 public:
  SmallFace(const CameraScene& scene, std::int32_t face, RasterBand& band)
      : scene_(scene), band_(band), face_(face) {}

  bool covers(std::size_t at) {
    return insideFace(scene_, face_, band_.ray_x[at], band_.ray_y[at]) && exact();
  }

  void put(std::size_t at) {
    const std::int32_t owner = band_.face[at];
    if (owner < 0) {
      band_.face[at] = face_;
      band_.inverse_depth[at] = RasterBand::kUnknownDepth;
      return;
    }
    if (depth_.high == 0) depth_ = depthRange(scene_, face_);
    const DepthRange other = depthRange(scene_, owner);
    if (depth_.low >= other.high + scene_.scale.gap) return;
    if (other.low >= depth_.high + scene_.scale.gap) {
      band_.face[at] = face_;
      band_.inverse_depth[at] = RasterBand::kUnknownDepth;
      return;
    }
    contest(at);
  }

 private:
  bool exact() {
    if (!prepared_) {
      prepared_ = true;
      visible_ = prepareFace(scene_, face_, drawn_);
    }
    return visible_;
  }

  /// Neither is clearly nearer: as the rasterizer compares.
  void contest(std::size_t at) {
    float inverse_depth = 0.0F;
    if (!exact() || !inverseDepthOn(drawn_, band_.ray_x[at], band_.ray_y[at], inverse_depth))
      return;
    resolveDepth(scene_, band_, at);
    const float before = band_.inverse_depth[at];
    if (inverse_depth > before || (inverse_depth == before && face_ < band_.face[at])) {
      band_.inverse_depth[at] = inverse_depth;
      band_.face[at] = face_;
    }
  }

  const CameraScene& scene_;
  RasterBand& band_;
  std::int32_t face_;
  bool prepared_ = false;
  bool visible_ = false;
  DepthRange depth_;
  DrawnFace drawn_;
};

}  // namespace

SmallFaces::SmallFaces(const CameraScene& scene, const RayGrid& rays) : scale_(scene.scale) {
  // Lines bend by at most k L^2 / 8; twice that, in steps.
  constexpr double kLength2 = 2.0 * kLargest_px * kLargest_px;
  const double bend = 0.25 * rays.lineBend_per_px() * kLength2 * scale_.steps();
  slack_ = 1 + ceilClamped(bend, 0, 1);
  largest_ = kLargest_px * scale_.steps();
  possible_ = rays.smooth() && bend <= 0.25;
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
  SmallFace small(scene, face, band);
  for (int y = box.y_first; y <= box.y_last; ++y)
    for (int x = box.x_first; x <= box.x_last; ++x) {
      const int located = fixed.locate(x * scale_.steps(), y * scale_.steps());
      if (located < 0) continue;
      const std::size_t at = band.index(x + scale_.middle_x, y - top + 1);
      if (located > 0 || small.covers(at)) small.put(at);
    }
}

void resolveDepths(const CameraScene& scene, RasterBand& band) {
  for (int row = 1; row <= band.rows; ++row)
    for (int x = band.x_begin; x < band.x_end; ++x) resolveDepth(scene, band, band.index(x, row));
}

}  // namespace boresight
