// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "sessions/io/mesh_container.h"

namespace boresight::sessions {

/// The part of checkMeshContainer for PLY (ASCII and binary of either byte order): walks every
/// element that the header declares to its last value. InputError.
MeshDeclaration checkPly(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
