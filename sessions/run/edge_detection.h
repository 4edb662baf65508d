// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/edges/edge_map.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// The test edges of an image as a run with these options has them, in memory of its own. `ignore`
/// (the image's size) may be nullptr. The core's statuses come back as they are. Throws
/// std::bad_alloc.
Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   EdgeMapTrace& output);

}  // namespace boresight::sessions
