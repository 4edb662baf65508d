// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sessions/io/file_bytes.h"
#include "sessions/io/mesh_container.h"

namespace boresight::sessions {

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

/// A mesh file and its buffers, each read once: no other file that the mesh may name.
struct MeshFiles {
  std::filesystem::path file;
  MeshFormat format = MeshFormat::kPly;
  std::vector<std::uint8_t> bytes;
  std::vector<MeshBuffer> buffers;  ///< of glTF, in its order; without those inside the file itself
  std::string sha256;               ///< of the file and its buffers, one after the other
};

/// Reads the files of a mesh without parsing its geometry. InputError: not readable, too large, a
/// buffer outside of the mesh's folder (also by a link).
MeshFiles readMeshFiles(const std::filesystem::path& file);

}  // namespace boresight::sessions
