// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include "core/base/kernels.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Copies what the core's record of an iteration holds, up to the stage that it reached: what lies
/// beyond still has the values of an earlier iteration and is left out.
IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level);

RenderTrace recordRender(const EdgeRender& render);
EdgeMapTrace recordEdgeMap(const EdgeMap& edges);

/// What a run may use of the machine: it changes the time taken and nothing else.
struct Execution {
  Kernels kernels = bestKernels();
};

/// Runs a whole localization with memory of its own: a loop around Localizer::step(). What is
/// recorded does not change what is computed. A stop is noticed between two steps and leaves the
/// status at kRunning. A problem that cannot run at all is a trace with kFault and without
/// iterations. Throws std::bad_alloc when there is no memory for the arena.
LocalizationTrace localize(const LocalizationProblem& problem, const LocalizerOptions& options,
                           RecordLevel level, const std::stop_token& stop = {},
                           const Execution& execution = {});

}  // namespace boresight::sessions
