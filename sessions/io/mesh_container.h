// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace boresight::sessions {

enum class MeshFormat { kPly, kObj, kStl, kGltf, kGlb };

const char* meshFormatName(MeshFormat format);

/// By the file's extension; InputError for any other than ply, obj, stl, gltf, glb.
MeshFormat meshFormatOf(const std::filesystem::path& file);

/// The same without throwing, and the reason for a message.
std::optional<MeshFormat> knownMeshFormat(const std::filesystem::path& file);
std::string unknownMeshFormat(const std::filesystem::path& file);

/// glTF is in metres; the others say nothing of their unit.
bool carriesUnit(MeshFormat format);

/// What a mesh file declares about its own size.
struct MeshDeclaration {
  std::optional<std::int64_t> vertex_count;
  std::optional<std::int64_t> polygon_count;
  /// Where the data of a binary PLY begin, when their first byte looks like the end of a line.
  std::optional<std::size_t> newline_as_data = {};
};

/// Checks that the bytes are of the format that the extension promises, and complete as far as the
/// format allows to see it (PLY: every element is there; STL: the facets or `endsolid`; GLB: the
/// stated length; a cut OBJ cannot be told from a short one). Importers accept cut files silently.
/// InputError.
MeshDeclaration checkMeshContainer(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes, MeshFormat format);

}  // namespace boresight::sessions
