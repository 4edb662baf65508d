// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::sessions {

/// A property of an element of a PLY file.
struct PlyProperty {
  std::string name;
  std::string type;        ///< of its values, e.g. "float32"
  std::string count_type;  ///< of a list's length; empty: one value

  bool isList() const { return !count_type.empty(); }
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::uint64_t body = 0;  ///< offset of the first byte after the header
};

/// Reads the header of a file that begins with `ply`. InputError.
PlyHeader readPlyHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// Bytes of a value; 0: not a PLY type.
int plyTypeSize(std::string_view type);

/// Takes the next word from the text; empty at its end.
std::string_view takeWord(std::string_view& text);

/// Whether importers cannot read the mesh: triangle strips, or faces before vertices.
bool needsPlainPly(const PlyHeader& header);

/// A mesh that passed checkPly as a binary file with vertices, then faces, and nothing else; strips
/// become triangles. InputError.
std::vector<std::uint8_t> plainPly(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
