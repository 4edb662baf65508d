// SPDX-License-Identifier: Apache-2.0
// Copies of the core's records of a run.
#pragma once

#include "sessions/run/trace.h"

namespace boresight::sessions {

/// Copies what the core's record of an iteration holds, up to the stage that it reached: what lies
/// beyond still has the values of an earlier iteration and is left out.
IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level);

/// Whether a pose came out of an iteration that reached a stage.
bool hasPose(const Iteration& iteration, Stage reached);

RenderTrace recordRender(const EdgeRender& render);
/// With kSummary: thresholds and count alone.
EdgeMapTrace recordEdgeMap(const EdgeMap& edges, RecordLevel level = RecordLevel::kFull);

}  // namespace boresight::sessions
