// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

enum class Stage : std::uint8_t {
  kEdges = 0,
  kRender,
  kTemplates,
  kMatch,
  kPose,
  kRefine,
  kSupport,
  kSearch,  ///< runs after the edges; listed last so that the stages of an iteration are
            ///< consecutive
  kFinished,
};
const char* stageText(Stage stage);

/// Result of one step.
struct StepReport {
  Stage stage = Stage::kEdges;      ///< the stage that was worked on
  bool stage_complete = false;      ///< the stage is done
  bool iteration_complete = false;  ///< its record is complete, up to the stage that failed
  bool finished = false;            ///< the run has ended; further steps do nothing

  /// A step on a stage inside an iteration.
  static StepReport of(Stage stage, bool stage_complete) { return {stage, stage_complete}; }
  /// A step of a run that has ended.
  static StepReport end(bool stage_complete) {
    return {Stage::kFinished, stage_complete, false, true};
  }
};

}  // namespace boresight
