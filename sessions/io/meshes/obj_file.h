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

/// The lines of a file for importers, which skip indented lines and take the line behind a name
/// with a backslash for its end: without indents and continued lines, names without backslashes.
std::vector<std::uint8_t> plainObj(std::string_view text);

}  // namespace boresight::sessions
