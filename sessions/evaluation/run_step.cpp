// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_step.h"

namespace boresight::sessions {
namespace {

RunStep stepOf(const IterationTrace& iteration, std::int32_t index) {
  RunStep step;
  step.index = index;
  step.attempt = iteration.attempt;
  step.kind = iteration.kind == IterationKind::kRefine ? "refine" : "match";
  step.level = iteration.level;
  step.status = localizationStatusText(iteration.status);
  step.threshold_px = iteration.threshold_px;
  step.templates = iteration.template_count;
  step.matches = iteration.searched_count;
  step.support = iteration.support();
  step.rms_px = iteration.rms_px();
  step.best_score = iteration.best_score;
  step.mean_score = iteration.mean_score;
  step.correction_mm = 1e3 * iteration.correction_translation_m;
  step.correction_mrad = 1e3 * iteration.correction_rotation_rad;
  step.correction_px = iteration.correction_image_px;
  step.seconds = iteration.seconds;
  step.camera_from_station = iteration.camera_from_station;
  if (!iteration.templates.empty()) step.details = matchDetails(iteration);
  return step;
}

}  // namespace

std::vector<RunStep> runSteps(const LocalizationTrace& trace, const Case& one) {
  std::vector<RunStep> steps;
  for (const auto& iteration : trace.iterations) {
    steps.push_back(stepOf(*iteration, static_cast<std::int32_t>(steps.size())));
    if (one.truth_camera_from_station)
      steps.back().error = poseError(*one.truth_camera_from_station, iteration->camera_from_station,
                                     one.camera_from_end_effector);
  }
  return steps;
}

}  // namespace boresight::sessions
