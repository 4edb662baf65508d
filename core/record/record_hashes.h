// SPDX-License-Identifier: Apache-2.0
// Hashes that show whether two runs detected and rendered the
// same edges: SHA-256 over big-endian values (FORMAT.md), the same on every machine. Nothing
// allocates.
#pragma once

#include <array>
#include <cstdint>

#include "core/edges/edge_map.h"
#include "core/render/edge_render.h"

namespace boresight {

using RecordHash = std::array<std::uint8_t, 32>;

/// Over every level of the image's edge map; all levels must be valid, as right after the edge
/// stage.
RecordHash edgeMapHash(const EdgeMap& edges);

/// Over the render: edges, mask, and all members of each edge pixel.
RecordHash renderHash(const EdgeRender& render);

}  // namespace boresight
