// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {

enum class MeshFormat { kPly, kObj, kStl, kGltf, kGlb };

const char* meshFormatName(MeshFormat format);

/// By the file's extension; InputError for any other than ply, obj, stl, gltf, glb.
MeshFormat meshFormatOf(const std::filesystem::path& file);

/// The same; empty for other extensions.
std::optional<MeshFormat> knownMeshFormat(const std::filesystem::path& file);
/// The message for a file of unknown format.
std::string unknownMeshFormat(const std::filesystem::path& file);

/// glTF is in metres; the other formats state no unit.
bool carriesUnit(MeshFormat format);

/// Size that a mesh file declares.
struct MeshDeclaration {
  std::optional<std::int64_t> vertex_count;
  std::optional<std::int64_t> polygon_count;  ///< empty: not stated
  /// Offset of the data of a binary PLY, when their first byte looks like a line end.
  std::optional<std::size_t> newline_as_data = {};
  /// A PLY mesh with triangle strips, with faces before vertices, with other lines than items, or
  /// with numbers that importers read otherwise: they get its plainPly().
  bool needs_plain_ply = false;
  std::vector<std::string> notes = {};  ///< for the operator: what importers leave out
};

/// Of a mesh file and its buffers together.
inline constexpr std::size_t kMaxMeshFileBytes = 512 * kMegabyte;

/// A file that a glTF file names as one of its buffers.
struct MeshBuffer {
  std::string place;             ///< of its entry in the glTF file, e.g. "buffers[0]"
  std::string uri;               ///< as the glTF file has it
  std::string name;              ///< relative to the mesh's folder
  std::size_t stated_bytes = 0;  ///< `byteLength`; the file may be longer
  std::vector<std::uint8_t> bytes;
};

/// A mesh file and its buffers, each read once; other files named in the mesh are not read.
struct MeshFiles {
  std::filesystem::path file;
  MeshFormat format = MeshFormat::kPly;
  std::vector<std::uint8_t> bytes;
  std::vector<MeshBuffer> buffers;  ///< of glTF, in its order; without those inside the file itself
  std::string sha256;               ///< of the file and its buffers, one after the other

  /// `bytes` without the byte order mark of a PLY or OBJ, and without what pads the end of an OBJ;
  /// all bytes of the other formats. InputError for UTF-16.
  std::span<const std::uint8_t> content() const;
};

/// Reads the files of a mesh without parsing its geometry. InputError: not readable, too large, a
/// buffer outside of the mesh's folder (also by a link).
MeshFiles readMeshFiles(const std::filesystem::path& file);

/// Checks that the mesh file has its extension's format, and is complete as far as the format shows
/// (PLY: every element is present; STL: every facet and `endsolid`; GLB: the stated length; of an
/// OBJ only an incomplete last line shows, which is noted), and requires no glTF extension that is
/// not read. Importers accept truncated files and such extensions silently. InputError.
MeshDeclaration checkMeshContainer(const MeshFiles& files);

/// The part of checkMeshContainer for PLY (ASCII and binary of either byte order): walks every
/// element that the header declares to its last value. InputError.
MeshDeclaration checkPly(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// Notes that the last line of a text has no line end: it may be cut off within a number.
void noteOpenEnd(std::string_view text, MeshDeclaration& declaration);

struct Mesh;

/// Reads files of which the first passed checkMeshContainer, places every mesh by the
/// transforms of its nodes, scales by `info.metres_per_unit`, and triangulates. Sets the
/// vertices and faces of `mesh`, not yet welded, and the counts of `info` that concern the
/// file; `info.file` is for messages. Checks every index and coordinate, as the importer or the
/// file may be faulty. Opens no file. InputError.
void importMesh(const MeshFiles& files, const MeshDeclaration& declared, Mesh& mesh);

/// InputError when `count` of `what` exceeds `limit`.
void requireAtMost(const std::filesystem::path& file, std::int64_t count, std::int64_t limit,
                   const char* what);

}  // namespace boresight::sessions
