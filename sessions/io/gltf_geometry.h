// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sessions/io/mesh_container.h"

namespace boresight::sessions {

/// A .gltf or .glb file with its geometry alone: nodes, triangles and where their numbers are.
/// Importers read, and crash on, the rest (skins, animations, images, extensions), of which nothing
/// is used. `bytes` passed checkMeshContainer.
std::vector<std::uint8_t> gltfGeometry(std::span<const std::uint8_t> bytes, MeshFormat format);

}  // namespace boresight::sessions
