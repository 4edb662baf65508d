// SPDX-License-Identifier: Apache-2.0
// By what the record tells whether two runs saw and rendered the same edges: SHA-256 over
// big-endian values (FORMAT.md), the same wherever it is computed. Nothing allocates.
#pragma once

#include <array>
#include <cstdint>

#include "core/edges/edge_map.h"
#include "core/render/edge_render.h"

namespace boresight {

using RecordHash = std::array<std::uint8_t, 32>;

/// Over every level of the image's edge map; all of them must be there, as they are when the edge
/// stage has just been completed.
RecordHash edgeMapHash(const EdgeMap& edges);

/// Over what was rendered: edges, mask, and all that is known of each edge pixel.
RecordHash renderHash(const EdgeRender& render);

}  // namespace boresight
