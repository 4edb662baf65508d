// SPDX-License-Identifier: Apache-2.0
// Walking through a run stage by stage.
#pragma once

#include <vector>

#include "sessions/run/trace.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// The stages of an iteration that can be looked at, as far as it came.
std::vector<Stage> stagesOf(const sessions::IterationTrace& iteration);

/// Which of `stages` the cursor's stage shows: the last one not after it, or 0.
int shownStage(const std::vector<Stage>& stages, Stage cursor);

/// The cursor one stage on or back, across iterations; at the ends it stays. The last stage of an
/// iteration is kFinished, so that a cursor there follows an iteration that is under way.
RunCursor nextStage(const sessions::LocalizationTrace& run, const RunCursor& cursor);
RunCursor previousStage(const sessions::LocalizationTrace& run, const RunCursor& cursor);

}  // namespace boresight::ui
