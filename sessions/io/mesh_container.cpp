// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_container.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/byte_cursor.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void truncated(const std::filesystem::path& file, const char* format) {
  throw InputError(file, std::string("the ") + format + " mesh is truncated");
}

// --- PLY ----------------------------------------------------------------------------------------

struct PlyProperty {
  int count_size = 0;  ///< bytes of a list's count; 0 for a plain value
  int value_size = 0;
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

int plyTypeSize(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float") return 4;
  if (type == "int32" || type == "uint32" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

void readPlyLine(const std::filesystem::path& file, const std::string& line, PlyHeader& header) {
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  if (keyword == "format") {
    std::string encoding;
    words >> encoding;
    if (encoding == "binary_little_endian")
      header.encoding = PlyEncoding::kLittleEndian;
    else if (encoding == "binary_big_endian")
      header.encoding = PlyEncoding::kBigEndian;
    else if (encoding != "ascii")
      throw InputError(file, "header", "unknown PLY encoding '" + encoding + "'");
  } else if (keyword == "element") {
    PlyElement element;
    std::int64_t count = -1;
    words >> element.name >> count;
    if (!words || count < 0) throw InputError(file, "header", "bad line '" + line + "'");
    element.count = static_cast<std::uint64_t>(count);
    header.elements.push_back(element);
  } else if (keyword == "property") {
    std::string type;
    std::string count_type;
    words >> type;
    PlyProperty property;
    if (type == "list") {
      words >> count_type >> type;
      property.count_size = plyTypeSize(count_type);
    }
    property.value_size = plyTypeSize(type);
    const bool bad_list = !count_type.empty() && property.count_size == 0;
    if (header.elements.empty() || property.value_size == 0 || bad_list)
      throw InputError(file, "header", "bad line '" + line + "'");
    header.elements.back().properties.push_back(property);
  }
}

PlyHeader readPlyHeader(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::size_t kMaxHeader = 65536;
  const std::string_view text = asText(bytes.first(std::min(bytes.size(), kMaxHeader)));
  PlyHeader header;
  std::size_t start = 0;
  while (true) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string_view::npos) {
      if (bytes.size() <= kMaxHeader) truncated(file, "PLY");
      throw InputError(file, "header", "no end_header within its first 64 kB");
    }
    std::string line(text.substr(start, end - start));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    start = end + 1;
    if (line == "end_header") break;
    readPlyLine(file, line, header);
  }
  header.body = start;
  return header;
}

/// Walks one binary element; returns the offset after it.
std::uint64_t walkPlyElement(const std::filesystem::path& file, Bytes bytes,
                             const PlyElement& element, bool big_endian, std::uint64_t offset) {
  std::uint64_t fixed_size = 0;
  bool has_list = false;
  for (const PlyProperty& property : element.properties) {
    fixed_size += static_cast<std::uint64_t>(property.value_size);
    has_list = has_list || property.count_size != 0;
  }
  if (!has_list) {
    if (fixed_size != 0 && element.count > bytes.size() / fixed_size) truncated(file, "PLY");
    if (!holds(bytes, offset, element.count * fixed_size)) truncated(file, "PLY");
    return offset + element.count * fixed_size;
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      std::uint64_t values = 1;
      if (property.count_size != 0) {
        if (!holds(bytes, offset, static_cast<std::uint64_t>(property.count_size)))
          truncated(file, "PLY");
        values = readUnsigned(bytes, offset, property.count_size, big_endian);
        offset += static_cast<std::uint64_t>(property.count_size);
      }
      if (values > bytes.size()) truncated(file, "PLY");
      const std::uint64_t size = values * static_cast<std::uint64_t>(property.value_size);
      if (!holds(bytes, offset, size)) truncated(file, "PLY");
      offset += size;
    }
  }
  return offset;
}

std::uint64_t filledLines(std::string_view text) {
  std::uint64_t count = 0;
  bool filled = false;
  for (const char c : text) {
    if (c == '\n') {
      count += filled ? 1 : 0;
      filled = false;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      filled = true;
    }
  }
  return count + (filled ? 1 : 0);
}

MeshDeclaration checkPly(const std::filesystem::path& file, Bytes bytes) {
  if (!asText(bytes).starts_with("ply\n") && !asText(bytes).starts_with("ply\r"))
    throw InputError(file, "not a PLY mesh (the file does not begin with 'ply')");
  const PlyHeader header = readPlyHeader(file, bytes);
  MeshDeclaration declaration;
  std::uint64_t items = 0;
  for (const PlyElement& element : header.elements) {
    // Any count of a file that we would accept fits; a sum of such counts cannot overflow.
    if (element.count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw InputError(file, "header", "too many items in element '" + element.name + "'");
    if (element.name == "vertex")
      declaration.vertex_count = static_cast<std::int64_t>(element.count);
    if (element.name == "face")
      declaration.polygon_count = static_cast<std::int64_t>(element.count);
    items += element.count;
  }
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  if (header.encoding == PlyEncoding::kAscii) {
    if (filledLines(asText(bytes.subspan(header.body))) < items) truncated(file, "PLY");
    return declaration;
  }
  std::uint64_t offset = header.body;
  for (const PlyElement& element : header.elements)
    offset =
        walkPlyElement(file, bytes, element, header.encoding == PlyEncoding::kBigEndian, offset);
  return declaration;
}

// --- STL, glTF ----------------------------------------------------------------------------------

MeshDeclaration checkStl(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::uint64_t kHeader = 84;
  constexpr std::uint64_t kFacet = 50;
  const std::string_view text = asText(bytes);
  MeshDeclaration declaration;
  const bool may_be_binary = bytes.size() >= kHeader;
  const std::uint64_t facets = may_be_binary ? readUnsigned(bytes, 80, 4, false) : 0;
  const bool fits_exactly = may_be_binary && bytes.size() == kHeader + facets * kFacet;
  // A binary header may begin with "solid" too; then only the exact size tells.
  if (text.starts_with("solid") && !fits_exactly) {
    if (text.find("endsolid") == std::string_view::npos) truncated(file, "STL");
    return declaration;
  }
  if (!may_be_binary) throw InputError(file, "not an STL mesh");
  if (facets == 0) throw InputError(file, "the mesh has no faces");
  if (bytes.size() < kHeader + facets * kFacet) truncated(file, "STL");
  declaration.polygon_count = static_cast<std::int64_t>(facets);
  return declaration;
}

MeshDeclaration checkGlb(const std::filesystem::path& file, Bytes bytes) {
  if (!asText(bytes).starts_with("glTF")) throw InputError(file, "not a GLB mesh");
  if (bytes.size() < 20 || bytes.size() < readUnsigned(bytes, 8, 4, false)) truncated(file, "GLB");
  return {};
}

}  // namespace

const char* meshFormatName(MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return "PLY";
    case MeshFormat::kObj:
      return "OBJ";
    case MeshFormat::kStl:
      return "STL";
    case MeshFormat::kGltf:
      return "glTF";
    case MeshFormat::kGlb:
      return "GLB";
  }
  return "unknown";
}

MeshFormat meshFormatOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".gltf") return MeshFormat::kGltf;
  if (extension == ".glb") return MeshFormat::kGlb;
  throw InputError(file, "unknown mesh format '" + extension + "' (ply, obj, stl, gltf, glb)");
}

bool carriesUnit(MeshFormat format) {
  return format == MeshFormat::kGltf || format == MeshFormat::kGlb;
}

MeshDeclaration checkMeshContainer(const std::filesystem::path& file, Bytes bytes,
                                   MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return checkPly(file, bytes);
    case MeshFormat::kStl:
      return checkStl(file, bytes);
    case MeshFormat::kGlb:
      return checkGlb(file, bytes);
    case MeshFormat::kObj:
    case MeshFormat::kGltf:
      return {};
  }
  return {};
}

}  // namespace boresight::sessions
