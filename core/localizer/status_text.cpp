// SPDX-License-Identifier: Apache-2.0
#include "core/base/enum_name.h"
#include "core/localizer/stage.h"
#include "core/localizer/workspace.h"

namespace boresight {

const char* localizationStatusText(LocalizationStatus status) {
  return enumName<kLastLocalizationStatus>(
      status, {"running", "converged", "left_uncertainty", "too_few_edges", "too_few_templates",
               "too_few_matches", "pnp_failed", "not_supported", "iteration_limit", "fault",
               "ambiguous", "blurred", "camera_mismatch"});
}

const char* stageText(Stage stage) {
  return enumName<Stage::kFinished>(stage, {"edges", "render", "templates", "match", "pose",
                                            "refine", "support", "search", "finished"});
}

}  // namespace boresight
