// SPDX-License-Identifier: Apache-2.0
// Copies of the core's records of a run.
#pragma once

#include "core/edges/edge_map.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Copies the core's record of an iteration up to the stage reached; later data is that of an
/// earlier iteration and is left out.
IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level);

/// Copies the poses that a run has compared so far.
void recordHypotheses(const Workspace& workspace, LocalizationTrace& trace);

/// Whether a pose came out of an iteration that reached a stage.
bool hasPose(const Iteration& iteration, Stage reached);

RenderTrace recordRender(const EdgeRender& render);
/// With kSummary: thresholds and count alone.
EdgeMapTrace recordEdgeMap(const EdgeMap& edges, RecordLevel level = RecordLevel::kFull);

/// The test edges of an image as in a run with these options, in separate memory. `ignore` (the
/// image's size) may be nullptr. Returns the core's status. Throws std::bad_alloc.
Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   EdgeMapTrace& output);

}  // namespace boresight::sessions
