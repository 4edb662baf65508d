// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_container.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/byte_cursor.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_document.h"

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

/// Words of a text body, one after the other.
class WordReader {
 public:
  explicit WordReader(std::string_view text) : text_(text) {}

  /// False at the end.
  bool skip(std::uint64_t words) {
    for (std::uint64_t i = 0; i < words; ++i)
      if (next().empty()) return false;
    return true;
  }

  std::string_view next() {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    const std::size_t start = at_;
    while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

 private:
  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::size_t at_ = 0;
};

void walkPlyText(const std::filesystem::path& file, const PlyHeader& header,
                 std::string_view body) {
  WordReader words(body);
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t values = 1;
        if (property.count_size != 0) {
          const std::string_view count = words.next();
          const auto result = std::from_chars(count.data(), count.data() + count.size(), values);
          if (count.empty()) truncated(file, "PLY");
          if (result.ec != std::errc() || values > body.size())
            throw InputError(file, element.name + " " + std::to_string(i),
                             "'" + std::string(count) + "' is not the length of a list");
        }
        if (!words.skip(values)) truncated(file, "PLY");
      }
}

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
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  if (header.encoding == PlyEncoding::kAscii) {
    walkPlyText(file, header, asText(bytes.subspan(header.body)));
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

/// Triangles of one glTF primitive; nothing for lines and points.
std::optional<std::int64_t> gltfTriangles(const JsonReader& primitive,
                                          const std::vector<JsonReader>& accessors) {
  constexpr std::int64_t kTriangles = 4;  // 5 is a strip, 6 a fan
  constexpr std::int64_t kFan = 6;
  const auto mode_json = primitive.find("mode");
  const std::int64_t mode = mode_json ? mode_json->integer(0, kFan) : kTriangles;
  if (mode < kTriangles) return std::nullopt;
  const JsonReader accessor = primitive.has("indices") ? primitive.at("indices")
                                                       : primitive.at("attributes").at("POSITION");
  const std::int64_t index = accessor.integer(0, static_cast<std::int64_t>(accessors.size()) - 1);
  const std::int64_t count = accessors[static_cast<std::size_t>(index)].at("count").integer(
      0, std::numeric_limits<std::int32_t>::max());
  return mode == kTriangles ? count / 3 : std::max<std::int64_t>(0, count - 2);
}

/// The nodes must form trees (glTF 2.0, 3.5): an importer follows shared or circular children to
/// the end of memory.
void checkGltfNodes(const JsonReader& json) {
  const auto nodes_json = json.find("nodes");
  if (!nodes_json) return;
  const std::vector<JsonReader> nodes = nodes_json->elements();
  const auto last = static_cast<std::int64_t>(nodes.size()) - 1;
  std::vector<bool> has_parent(nodes.size(), false);
  for (const JsonReader& node : nodes)
    if (const auto children = node.find("children"))
      for (const JsonReader& child : children->elements()) {
        const auto index = static_cast<std::size_t>(child.integer(0, last));
        if (has_parent[index]) child.fail("the node has two parents");
        has_parent[index] = true;
      }
  if (const auto scenes = json.find("scenes"))
    for (const JsonReader& scene : scenes->elements())
      if (const auto roots = scene.find("nodes"))
        for (const JsonReader& root : roots->elements())
          if (has_parent[static_cast<std::size_t>(root.integer(0, last))])
            root.fail("the scene's root is another node's child");
}

/// Importers leave out faces with bad indices; the count that the file declares shows it.
MeshDeclaration checkGltfJson(const std::filesystem::path& file, std::string_view text) {
  const JsonDocument document(file, text);
  const JsonReader json = document.root();
  MeshDeclaration declaration;
  const auto accessors = json.find("accessors");
  const auto meshes = json.find("meshes");
  if (!accessors || !meshes) throw InputError(file, "the mesh has no faces");
  checkGltfNodes(json);
  const std::vector<JsonReader> all_accessors = accessors->elements();
  std::int64_t triangles = 0;
  for (const JsonReader& mesh : meshes->elements())
    for (const JsonReader& primitive : mesh.at("primitives").elements()) {
      const std::optional<std::int64_t> count = gltfTriangles(primitive, all_accessors);
      if (!count) return declaration;
      triangles += *count;
    }
  declaration.polygon_count = triangles;
  return declaration;
}

MeshDeclaration checkGlb(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::uint64_t kHeader = 20;
  if (!asText(bytes).starts_with("glTF")) throw InputError(file, "not a GLB mesh");
  if (bytes.size() < kHeader || bytes.size() < readUnsigned(bytes, 8, 4, false))
    truncated(file, "GLB");
  const std::uint64_t json_size = readUnsigned(bytes, 12, 4, false);
  if (!holds(bytes, kHeader, json_size)) truncated(file, "GLB");
  return checkGltfJson(file, asText(bytes.subspan(kHeader, json_size)));
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

std::optional<MeshFormat> knownMeshFormat(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".gltf") return MeshFormat::kGltf;
  if (extension == ".glb") return MeshFormat::kGlb;
  return std::nullopt;
}

std::string unknownMeshFormat(const std::filesystem::path& file) {
  return "unknown mesh format '" + file.extension().string() + "' (ply, obj, stl, gltf, glb)";
}

MeshFormat meshFormatOf(const std::filesystem::path& file) {
  const std::optional<MeshFormat> format = knownMeshFormat(file);
  if (!format) throw InputError(file, unknownMeshFormat(file));
  return *format;
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
    case MeshFormat::kGltf:
      return checkGltfJson(file, asText(bytes));
    case MeshFormat::kObj:
      return {};
  }
  return {};
}

}  // namespace boresight::sessions
