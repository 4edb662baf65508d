// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/trace.h"

namespace boresight::sessions {

BitImage BitMap::view() const {
  BitImage image;
  image.words = {const_cast<std::uint64_t*>(words.data()), words.size()};
  image.width = width;
  image.height = height;
  image.words_per_row = BitImage::wordsPerRow(width);
  return image;
}

RenderView RenderTrace::view() const {
  RenderView view;
  view.pixels = std::vector<PackedEdgePixel>(pixels.begin(), pixels.end());
  EdgeRender& render = view.render;
  render.edges = edges.view();
  render.mask = mask.view();
  render.pixels = view.pixels;
  render.row_begin = {const_cast<std::int32_t*>(row_begin.data()), row_begin.size()};
  render.pixel_count = static_cast<std::int32_t>(pixels.size());
  render.camera = camera;
  render.camera_from_station = camera_from_station;
  return view;
}

void StageSeconds::add(Stage stage, double seconds) {
  switch (stage) {
    case Stage::kEdges:
    case Stage::kSearch:
      initialization += seconds;
      break;
    case Stage::kRender:
      rendering += seconds;
      break;
    case Stage::kTemplates:
    case Stage::kMatch:
      matching += seconds;
      break;
    case Stage::kPose:
      pose += seconds;
      break;
    case Stage::kRefine:
    case Stage::kSupport:
      refinement += seconds;
      break;
    case Stage::kFinished:
      break;
  }
}

StageSeconds& StageSeconds::operator+=(const StageSeconds& other) {
  initialization += other.initialization;
  rendering += other.rendering;
  matching += other.matching;
  pose += other.pose;
  refinement += other.refinement;
  return *this;
}

std::int32_t IterationTrace::support() const {
  return kind == IterationKind::kRefine ? refinement.used_count : pnp.inlier_count;
}

double IterationTrace::rms_px() const {
  return kind == IterationKind::kRefine ? refinement.rms_px : pnp.rms_px;
}

bool ViewOutcome::tookPart() const {
  return status == localizationStatusText(LocalizationStatus::kConverged);
}

}  // namespace boresight::sessions
