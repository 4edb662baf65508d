// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "sessions/io/meshes/mesh_container.h"

namespace boresight::sessions {

/// The part of checkMeshContainer for STL, ASCII and binary: reads every facet of every solid of an
/// ASCII file. InputError.
MeshDeclaration checkStl(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// The facets of all solids of a file that passed checkStl, as a binary file without normals and
/// names; coordinates are rounded once. InputError.
std::vector<std::uint8_t> plainStl(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
