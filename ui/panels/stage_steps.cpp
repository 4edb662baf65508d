// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/stage_steps.h"

#include <cstddef>

namespace boresight::ui {
namespace {

/// The cursor on a stage of an iteration; index counts within stagesOf.
RunCursor cursorAt(const sessions::LocalizationTrace& run, int iteration, int stage) {
  const auto stages = stagesOf(*run.iterations[static_cast<std::size_t>(iteration)]);
  const bool last = stage + 1 >= static_cast<int>(stages.size());
  return {iteration, last ? Stage::kFinished : stages[static_cast<std::size_t>(stage)]};
}

int stageCount(const sessions::LocalizationTrace& run, int iteration) {
  return static_cast<int>(stagesOf(*run.iterations[static_cast<std::size_t>(iteration)]).size());
}

int stageUnder(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  return shownStage(stagesOf(*run.iterations[static_cast<std::size_t>(cursor.iteration)]),
                    cursor.stage);
}

}  // namespace

std::vector<Stage> stagesOf(const sessions::IterationTrace& iteration) {
  const bool refines = iteration.kind == IterationKind::kRefine;
  const std::vector<Stage> all =
      refines ? std::vector<Stage>{Stage::kRender, Stage::kRefine}
              : std::vector<Stage>{Stage::kRender, Stage::kTemplates, Stage::kMatch, Stage::kPose};
  std::vector<Stage> reached;
  for (const Stage stage : all)
    if (stage == Stage::kRender || stage <= iteration.reached) reached.push_back(stage);
  return reached;
}

int shownStage(const std::vector<Stage>& stages, Stage cursor) {
  int shown = 0;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i] <= cursor) shown = static_cast<int>(i);
  return shown;
}

RunCursor nextStage(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  const int last = static_cast<int>(run.iterations.size()) - 1;
  if (cursor.iteration < 0) return last < 0 ? cursor : cursorAt(run, 0, 0);
  const int stage = stageUnder(run, cursor);
  if (stage + 1 < stageCount(run, cursor.iteration))
    return cursorAt(run, cursor.iteration, stage + 1);
  return cursor.iteration < last ? cursorAt(run, cursor.iteration + 1, 0) : cursor;
}

RunCursor previousStage(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  if (cursor.iteration < 0) return cursor;
  const int stage = stageUnder(run, cursor);
  if (stage > 0) return cursorAt(run, cursor.iteration, stage - 1);
  if (cursor.iteration == 0) return {-1, Stage::kFinished};
  return {cursor.iteration - 1, Stage::kFinished};
}

}  // namespace boresight::ui
