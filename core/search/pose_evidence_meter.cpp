// SPDX-License-Identifier: Apache-2.0
#include "core/search/pose_evidence_meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/nth.h"

namespace boresight {
namespace {

/// Longest side of each view: holds the object with its margins.
constexpr std::array<int, kEvidenceViews> kLongestView_px = {312, 512};
constexpr double kAlongNormal_px = 4.0;  ///< step that gives a normal's direction in the view

/// A pixel of the render, in the view.
bool inView(const EdgeRender& render, const Eigen::Vector2d& pixel, const FacingView& view,
            const Eigen::Matrix3d& view_from_camera, Eigen::Vector2d& view_px) {
  Eigen::Vector3d ray;
  if (!unproject(render.camera, pixel, ray)) return false;
  return projectDirection(view.camera, view_from_camera * ray, view_px);
}

}  // namespace

ViewSize evidenceViewSize(int view) {
  const auto at = static_cast<std::size_t>(view);
  ViewSize size;
  size.span_px = kEvidenceSpan_px[at];
  size.margin_px = kViewMargin * size.span_px;
  size.most_px = kLongestView_px[at];
  return size;
}

void takePlaces(const EdgeRender& render, ContourEvidenceMeter& meter) {
  const std::int32_t stride = render.strideFor(ContourEvidenceMeter::kMaxPlaces);
  meter.clear(stride);
  for (const EdgePixel& pixel : render.eachPixel(stride)) {
    meter.add({pixel.x, pixel.y, edgeDirectionOf(pixel.normal_x, pixel.normal_y), isBorder(pixel)});
  }
}

Status PoseEvidenceMeter::create(int channels, Arena& arena) {
  constexpr int kLongest_px = kLongestView_px.back();
  // The edges are complete when places are added.
  const std::size_t after_edges = view_edges_.create(kLongest_px, channels, arena);
  const std::size_t end_of_view = arena.mark();
  arena.rewind(after_edges);
  meter_.create(static_cast<std::size_t>(kLongest_px) * kLongest_px, arena);
  arena.rewind(std::max(end_of_view, arena.mark()));
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

bool PoseEvidenceMeter::begin(const SearchProblem& problem, const EdgeRender& render) {
  problem_ = &problem;
  render_ = &render;
  contours_ = {};
  view_ = 0;
  return beginView();
}

bool PoseEvidenceMeter::beginView() {
  return view_edges_.begin(*problem_, render_->camera_from_station, evidenceViewSize(view_));
}

bool PoseEvidenceMeter::step() {
  if (!view_edges_.step()) return false;
  meter_.begin(view_edges_.edges());
  takePlacesOfRender();
  nth(contours_, view_) = meter_.measure(view_edges_.view().span_px);
  return ++view_ == kEvidenceViews || !beginView();
}

void PoseEvidenceMeter::takePlacesOfRender() {
  const FacingView& view = view_edges_.view();
  const Eigen::Matrix3d view_from_camera = view.view_from_camera.matrix();
  const std::int32_t stride = render_->strideFor(ContourEvidenceMeter::kMaxPlaces);
  const double scale = static_cast<double>(problem_->camera.width) / render_->camera.width;
  meter_.clear(stride * scale * view.pixels_per_px);
  for (const EdgePixel& pixel : render_->eachPixel(stride)) {
    const Eigen::Vector2d place = pixel.onLine_px();
    Eigen::Vector2d at;
    Eigen::Vector2d ahead;
    if (!inView(*render_, place, view, view_from_camera, at) ||
        !inView(*render_, place + kAlongNormal_px * pixel.normal(), view, view_from_camera,
                ahead) ||
        !(at.cwiseAbs().maxCoeff() < 1e4))
      continue;
    const Eigen::Vector2d way = 1024.0 * (ahead - at).normalized();
    meter_.add(
        {static_cast<std::int16_t>(std::floor(at.x() + 0.5)),
         static_cast<std::int16_t>(std::floor(at.y() + 0.5)),
         edgeDirectionOf(static_cast<std::int32_t>(way.x()), static_cast<std::int32_t>(way.y())),
         isBorder(pixel)});
  }
}

}  // namespace boresight
