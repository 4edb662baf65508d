// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_container.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/digest.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr const char* kFormatNames[] = {"PLY", "OBJ", "STL", "glTF", "GLB"};  ///< by MeshFormat

[[noreturn]] void truncatedMesh(const std::filesystem::path& file, const char* format) {
  throw InputError(file, std::string("the ") + format + " mesh is truncated");
}

MeshDeclaration checkStl(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::uint64_t kHeader = 84;
  constexpr std::uint64_t kFacet = 50;
  const std::string_view text = asText(bytes);
  MeshDeclaration declaration;
  const bool may_be_binary = bytes.size() >= kHeader;
  const std::uint64_t facets = may_be_binary ? readUnsigned(bytes, 80, 4, false) : 0;
  const bool fits_exactly = may_be_binary && bytes.size() == kHeader + facets * kFacet;
  // A binary header may begin with "solid" too; then only the exact size distinguishes them.
  if (text.starts_with("solid") && !fits_exactly) {
    if (text.find("endsolid") == std::string_view::npos) truncatedMesh(file, "STL");
    return declaration;
  }
  if (!may_be_binary) throw InputError(file, "not an STL mesh");
  if (facets == 0) throw InputError(file, "the mesh has no faces");
  if (bytes.size() < kHeader + facets * kFacet) truncatedMesh(file, "STL");
  if (const std::uint64_t there = (bytes.size() - kHeader) / kFacet; there != facets)
    throw InputError(file, "header",
                     "declares " + std::to_string(facets) + " facets, but the file can hold only " +
                         std::to_string(there));
  declaration.polygon_count = static_cast<std::int64_t>(facets);
  return declaration;
}

const JsonReader& accessorAt(const JsonReader& index, const std::vector<JsonReader>& accessors) {
  const std::int64_t last = static_cast<std::int64_t>(accessors.size()) - 1;
  const JsonReader& accessor = accessors[static_cast<std::size_t>(index.integer(0, last))];
  if (accessor.has("sparse"))
    accessor.failMember("sparse", "is not read: write the mesh without sparse accessors");
  return accessor;
}

/// Triangles of one glTF primitive; nothing for lines and points.
std::optional<std::int64_t> gltfTriangles(const JsonReader& primitive,
                                          const std::vector<JsonReader>& accessors) {
  constexpr std::int64_t kTriangles = 4;  // 5 is a strip, 6 a fan
  constexpr std::int64_t kFan = 6;
  const auto mode_json = primitive.find("mode");
  const std::int64_t mode = mode_json ? mode_json->integer(0, kFan) : kTriangles;
  if (mode < kTriangles) return std::nullopt;
  JsonReader corners = accessorAt(primitive.at("attributes").at("POSITION"), accessors);
  if (const auto indices = primitive.find("indices")) corners = accessorAt(*indices, accessors);
  const std::int64_t count =
      corners.at("count").integer(0, std::numeric_limits<std::int32_t>::max());
  return mode == kTriangles ? count / 3 : std::max<std::int64_t>(0, count - 2);
}

/// Importers follow children by calling themselves: deeper nodes would exhaust the stack.
constexpr std::size_t kMaxNodeDepth = 256;
constexpr std::size_t kMaxNodes = 100'000;

void checkDepth(const std::vector<JsonReader>& nodes, const std::vector<std::size_t>& parent) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::size_t depth = 1;
    for (std::size_t at = parent[i]; at < nodes.size() && depth <= kMaxNodeDepth; at = parent[at])
      ++depth;
    if (depth > kMaxNodeDepth)
      nodes[i].fail("is nested deeper than " + std::to_string(kMaxNodeDepth) +
                    " nodes, or is its own ancestor");
  }
}

/// The nodes must form trees (glTF 2.0, 3.5): an importer follows shared or circular children to
/// the end of memory.
void checkGltfNodes(const JsonReader& gltf) {
  const auto nodes_json = gltf.find("nodes");
  if (!nodes_json) return;
  const std::vector<JsonReader> nodes = nodes_json->elements();
  if (nodes.size() > kMaxNodes)
    nodes_json->fail(std::to_string(nodes.size()) + " nodes exceed the limit of " +
                     std::to_string(kMaxNodes));
  const auto last = static_cast<std::int64_t>(nodes.size()) - 1;
  const std::size_t none = nodes.size();
  std::vector<std::size_t> parent(nodes.size(), none);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const auto children = nodes[i].find("children"))
      for (const JsonReader& child : children->elements()) {
        const auto index = static_cast<std::size_t>(child.integer(0, last));
        if (parent[index] != none) child.fail("the node has two parents");
        parent[index] = i;
      }
  if (const auto scenes = gltf.find("scenes"))
    for (const JsonReader& scene : scenes->elements())
      if (const auto roots = scene.find("nodes"))
        for (const JsonReader& root : roots->elements())
          if (parent[static_cast<std::size_t>(root.integer(0, last))] != none)
            root.fail("the scene's root is another node's child");
  checkDepth(nodes, parent);
}

/// Importers leave out faces with bad indices; the count that the file declares shows it.
MeshDeclaration checkGltfJson(const std::filesystem::path& file, std::string_view text) {
  const JsonDocument document(file, text);
  const JsonReader gltf = document.root();
  MeshDeclaration declaration;
  const auto accessors = gltf.find("accessors");
  const auto meshes = gltf.find("meshes");
  if (!accessors || !meshes) throw InputError(file, "the mesh has no faces");
  checkGltfNodes(gltf);
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
    truncatedMesh(file, "GLB");
  const std::uint64_t json_size = readUnsigned(bytes, 12, 4, false);
  if (!holds(bytes, kHeader, json_size)) truncatedMesh(file, "GLB");
  return checkGltfJson(file, asText(bytes.subspan(kHeader, json_size)));
}

namespace fs = std::filesystem;

/// The file name of a URI, in which %20 and the like encode characters.
std::string nameOf(const std::string& uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto code = numberIn<unsigned>(std::string_view(uri).substr(i + 1, 2), 16);
    const bool encoded = uri[i] == '%' && i + 2 < uri.size() && code;
    name += encoded ? static_cast<char>(*code) : uri[i];
    if (encoded) i += 2;
  }
  return name;
}

/// Whether the name leads to a place in the file's folder, also where its parts are links.
bool staysBeside(const fs::path& file, const fs::path& name) {
  if (name.is_absolute()) return false;
  for (const fs::path& part : name)
    if (part == "..") return false;
  std::error_code error;
  const fs::path top = fs::weakly_canonical(fs::absolute(file).parent_path(), error);
  if (error) return false;
  const fs::path target = fs::weakly_canonical(top / name, error);
  return !error && *target.lexically_relative(top).begin() != "..";
}

void readBuffers(MeshFiles& files) {
  const JsonDocument document(files.file, asText(files.bytes));
  const auto buffers = document.root().find("buffers");
  if (!buffers) return;
  std::size_t room = kMaxMeshFileBytes - files.bytes.size();
  for (const JsonReader& buffer : buffers->elements()) {
    const auto uri = buffer.find("uri");
    if (!uri || uri->text().starts_with("data:")) continue;
    const std::string name = nameOf(uri->nonEmptyText());
    if (!staysBeside(files.file, name))
      uri->fail("'" + name + "' is not in the mesh's folder; only buffers in that folder are read");
    const auto stated = static_cast<std::size_t>(buffer.at("byteLength").integer(0));
    files.buffers.push_back({buffer.place(), uri->text(), name, stated,
                             readFileBytes(files.file.parent_path() / name, room)});
    room -= files.buffers.back().bytes.size();
  }
}

}  // namespace

const char* meshFormatName(MeshFormat format) { return kFormatNames[static_cast<int>(format)]; }

std::optional<MeshFormat> knownMeshFormat(const std::filesystem::path& file) {
  for (int i = 0; i < std::ssize(kFormatNames); ++i)
    if (lowerCase(file.extension().string()) == "." + lowerCase(kFormatNames[i]))
      return static_cast<MeshFormat>(i);
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

MeshDeclaration checkMeshContainer(const MeshFiles& files) {
  switch (files.format) {
    case MeshFormat::kPly:
      return checkPly(files.file, files.bytes);
    case MeshFormat::kStl:
      return checkStl(files.file, files.bytes);
    case MeshFormat::kGlb:
      return checkGlb(files.file, files.bytes);
    case MeshFormat::kGltf:
      return checkGltfJson(files.file, asText(files.bytes));
    case MeshFormat::kObj:
      break;  // declares nothing
  }
  return {};
}

MeshFiles readMeshFiles(const fs::path& file) {
  MeshFiles files;
  files.file = file;
  files.format = meshFormatOf(file);
  files.bytes = readFileBytes(file, kMaxMeshFileBytes);
  if (files.format == MeshFormat::kGltf) readBuffers(files);
  Sha256 sha;
  sha.update(files.bytes);
  for (const MeshBuffer& buffer : files.buffers) sha.update(buffer.bytes);
  files.sha256 = hexText(sha.digest()).data();
  return files;
}

}  // namespace boresight::sessions
