// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_container.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/meshes/ply_header.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void truncatedPly(const std::filesystem::path& file) {
  throw InputError(file, "the PLY mesh is truncated");
}

/// Walks one binary element; returns the offset after it.
std::uint64_t walkPlyElement(const std::filesystem::path& file, Bytes bytes,
                             const PlyElement& element, bool big_endian, std::uint64_t offset) {
  const auto step = [&](std::uint64_t values, int size) {
    if (values > bytes.size() || !holds(bytes, offset, values * static_cast<std::uint64_t>(size)))
      truncatedPly(file);
    offset += values * static_cast<std::uint64_t>(size);
  };
  if (element.properties.empty()) return offset;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties) {
      std::uint64_t values = 1;
      if (const int size = plyTypeSize(property.count_type); size != 0) {
        step(1, size);
        values = readUnsigned(bytes, offset - static_cast<std::uint64_t>(size), size, big_endian);
      }
      step(values, plyTypeSize(property.type));
    }
  return offset;
}

/// Returns the offset after the last element.
std::uint64_t walkPlyText(const std::filesystem::path& file, const PlyHeader& header,
                          std::string_view body) {
  std::string_view rest = body;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t values = 1;
        if (property.isList()) {
          const std::string_view count = takeWord(rest);
          if (count.empty()) truncatedPly(file);
          values = numberIn<std::uint64_t>(count).value_or(body.size() + 1);
          if (values > body.size())
            throw InputError(file, element.name + " " + std::to_string(i),
                             "'" + std::string(count) + "' is not the length of a list");
        }
        for (; values > 0; --values)
          if (takeWord(rest).empty()) truncatedPly(file);
      }
  return header.body + (body.size() - rest.size());
}

/// A count that is too small would leave out what is behind.
void requireEnd(const std::filesystem::path& file, const PlyHeader& header, Bytes rest) {
  if (asText(rest).find_first_not_of(" \t\r\n") == std::string_view::npos) return;
  std::string declared;
  for (const PlyElement& element : header.elements)
    declared += (declared.empty() ? "" : ", ") + element.name + " " + std::to_string(element.count);
  throw InputError(file, "header",
                   "declares " + declared + ", but " + std::to_string(rest.size()) +
                       " more bytes follow these elements");
}

}  // namespace

MeshDeclaration checkPly(const std::filesystem::path& file, Bytes bytes) {
  if (!asText(bytes).starts_with("ply\n") && !asText(bytes).starts_with("ply\r"))
    throw InputError(file, "not a PLY mesh (the file does not begin with 'ply')");
  const PlyHeader header = readPlyHeader(file, bytes);
  MeshDeclaration declaration;
  for (const PlyElement& element : header.elements) {
    // Any count of a file that we would accept fits.
    if (element.count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw InputError(file, "header", "too many items in element '" + element.name + "'");
    if (element.name == "vertex")
      declaration.vertex_count = static_cast<std::int64_t>(element.count);
    if (element.name == "face")
      declaration.polygon_count = static_cast<std::int64_t>(element.count);
  }
  declaration.needs_plain_ply = needsPlainPly(header);
  if (declaration.needs_plain_ply) declaration.polygon_count.reset();
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  std::uint64_t offset = header.body;
  if (header.encoding == PlyEncoding::kAscii) {
    offset = walkPlyText(file, header, asText(bytes.subspan(header.body)));
  } else {
    if (offset < bytes.size() && bytes[offset] == '\n' && bytes[offset - 2] != '\r')
      declaration.newline_as_data = static_cast<std::size_t>(offset);
    for (const PlyElement& element : header.elements)
      offset =
          walkPlyElement(file, bytes, element, header.encoding == PlyEncoding::kBigEndian, offset);
  }
  requireEnd(file, header, bytes.subspan(offset));
  return declaration;
}

}  // namespace boresight::sessions
