// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/stage.h"
#include "core/localizer/workspace.h"

namespace boresight {

const char* localizationStatusText(LocalizationStatus status) {
  switch (status) {
    case LocalizationStatus::kRunning:
      return "running";
    case LocalizationStatus::kConverged:
      return "converged";
    case LocalizationStatus::kLeftUncertainty:
      return "left_uncertainty";
    case LocalizationStatus::kTooFewEdges:
      return "too_few_edges";
    case LocalizationStatus::kTooFewTemplates:
      return "too_few_templates";
    case LocalizationStatus::kTooFewMatches:
      return "too_few_matches";
    case LocalizationStatus::kPnpFailed:
      return "pnp_failed";
    case LocalizationStatus::kNotSupported:
      return "not_supported";
    case LocalizationStatus::kIterationLimit:
      return "iteration_limit";
    case LocalizationStatus::kFault:
      return "fault";
    case LocalizationStatus::kAmbiguous:
      return "ambiguous";
    case LocalizationStatus::kBlurred:
      return "blurred";
    case LocalizationStatus::kCameraMismatch:
      return "camera_mismatch";
  }
  return "unknown";
}

const char* stageText(Stage stage) {
  switch (stage) {
    case Stage::kEdges:
      return "edges";
    case Stage::kSearch:
      return "search";
    case Stage::kRender:
      return "render";
    case Stage::kTemplates:
      return "templates";
    case Stage::kMatch:
      return "match";
    case Stage::kPose:
      return "pose";
    case Stage::kRefine:
      return "refine";
    case Stage::kSupport:
      return "support";
    case Stage::kFinished:
      return "finished";
  }
  return "unknown";
}

}  // namespace boresight
