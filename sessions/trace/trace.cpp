// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/trace.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

bool isStatus(const std::string& text, LocalizationStatus status) {
  return text == localizationStatusText(status);
}

}  // namespace

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

bool ViewOutcome::tookPart() const { return isStatus(status, LocalizationStatus::kConverged); }

std::string leftOutText(const std::string& status) {
  if (isStatus(status, LocalizationStatus::kTooFewEdges))
    return "too few of its edges are rendered or found";
  if (isStatus(status, LocalizationStatus::kTooFewTemplates)) return "too few templates";
  if (isStatus(status, LocalizationStatus::kTooFewMatches))
    return "too few of its templates match edges of the image";
  if (isStatus(status, LocalizationStatus::kPnpFailed))
    return "too few of its matches or edges agree with the pose of the others";
  if (isStatus(status, LocalizationStatus::kNotSupported))
    return "its edge support is below the limit";
  return status;
}

std::string togetherText(const std::vector<ViewOutcome>& views, const std::string& own_case) {
  const bool converged = std::any_of(views.begin(), views.end(),
                                     [](const ViewOutcome& view) { return view.tookPart(); });
  std::vector<std::string> names;
  for (const ViewOutcome& view_outcome : views) {
    if (view_outcome.case_id == own_case) continue;
    const bool out = converged && !view_outcome.tookPart();
    names.push_back(view_outcome.case_id +
                    (out ? " (left out: " + leftOutText(view_outcome.status) + ")" : ""));
  }
  std::string text = "together with ";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace boresight::sessions
