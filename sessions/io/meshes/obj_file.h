// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "sessions/io/meshes/mesh_container.h"

namespace boresight::sessions {

/// The part of checkMeshContainer for OBJ: reads every vertex and every face; a missing end of the
/// last line is noted. InputError.
MeshDeclaration checkObj(const std::filesystem::path& file, std::string_view text);

/// The vertices and polygons of a file for importers, which refuse or misread other lines (normals,
/// texture coordinates, names) that are not used: coordinates and indices alone.
std::vector<std::uint8_t> plainObj(std::string_view text);

}  // namespace boresight::sessions
