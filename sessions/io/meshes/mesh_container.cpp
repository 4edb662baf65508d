// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_container.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/meshes/obj_file.h"
#include "sessions/io/meshes/stl_file.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr const char* kFormatNames[] = {"PLY", "OBJ", "STL", "glTF", "GLB"};  ///< by MeshFormat

[[noreturn]] void truncatedMesh(const std::filesystem::path& file, const char* format) {
  throw InputError(file, std::string("the ") + format + " mesh is truncated");
}

/// Extensions that leave the geometry as it is: materials, lights, behaviour, metadata.
bool isHarmlessExtension(std::string_view name) {
  constexpr std::string_view kBegins[] = {"KHR_materials_",
                                          "KHR_texture_",
                                          "KHR_lights_",
                                          "KHR_xmp",
                                          "KHR_animation_pointer",
                                          "KHR_techniques_",
                                          "KHR_audio_",
                                          "KHR_physics_",
                                          "KHR_interactivity",
                                          "KHR_node_hoverability",
                                          "KHR_node_selectability",
                                          "EXT_texture_",
                                          "EXT_lights_",
                                          "EXT_mesh_features",
                                          "EXT_mesh_manifold",
                                          "EXT_instance_features",
                                          "EXT_structural_metadata",
                                          "MSFT_texture_",
                                          "MSFT_packing_",
                                          "MSFT_audio_",
                                          "MSFT_lod",
                                          "MSFT_physics",
                                          "ADOBE_materials_",
                                          "NV_materials_",
                                          "AGI_stk_metadata",
                                          "CESIUM_primitive_outline",
                                          "FB_ngon_encoding"};
  return std::ranges::any_of(kBegins,
                             [name](std::string_view begin) { return name.starts_with(begin); });
}

/// Why a required extension is refused, and what to do.
std::string extensionRefusal(std::string_view name) {
  if (name.find("compression") != std::string_view::npos)
    return "is not read: export the mesh without compression";
  if (name == "EXT_mesh_gpu_instancing")
    return "is not read: export each instance as a node of its own";
  if (name == "KHR_node_visibility")
    return "is not read: export the visible nodes alone, without the extension";
  return "is not known and may change the geometry: export the mesh without it";
}

/// A reader must refuse a file that requires what it does not know (glTF 2.0, 3.12). Of quantized
/// meshes positionsOf refuses the positions.
void checkRequiredExtensions(const JsonReader& gltf) {
  const auto required = gltf.find("extensionsRequired");
  if (!required) return;
  for (const JsonReader& name : required->elements())
    if (!isHarmlessExtension(name.text()) && name.text() != "KHR_mesh_quantization")
      name.fail("'" + name.text() + "' " + extensionRefusal(name.text()));
}

/// Compressed data, which importers take for zeros where its extension is optional.
void checkBufferViews(const JsonReader& gltf) {
  const auto views = gltf.find("bufferViews");
  if (!views) return;
  for (const JsonReader& view : views->elements())
    if (const auto extensions = view.find("extensions"))
      for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (extensions->has(name)) extensions->failMember(name, extensionRefusal(name));
}

const JsonReader& accessorAt(const JsonReader& index, const std::vector<JsonReader>& accessors) {
  const std::int64_t last = static_cast<std::int64_t>(accessors.size()) - 1;
  const JsonReader& accessor = accessors[static_cast<std::size_t>(index.integer(0, last))];
  if (accessor.has("sparse"))
    accessor.failMember("sparse", "is not read: write the mesh without sparse accessors");
  if (!accessor.has("bufferView"))
    accessor.failMember("bufferView", "is missing: export the mesh without compression");
  return accessor;
}

/// Positions that are not float are quantized, with or without the extension's name.
JsonReader positionsOf(const JsonReader& primitive, const std::vector<JsonReader>& accessors) {
  constexpr std::int64_t kFloat = 5126;
  JsonReader positions = accessorAt(primitive.at("attributes").at("POSITION"), accessors);
  if (positions.at("componentType").integer(0) != kFloat)
    positions.failMember("componentType",
                         "is not float (5126): export the mesh without KHR_mesh_quantization");
  return positions;
}

/// Triangles of one glTF primitive; nothing for lines and points.
std::optional<std::int64_t> gltfTriangles(const JsonReader& primitive,
                                          const std::vector<JsonReader>& accessors) {
  constexpr std::int64_t kTriangles = 4;  // 5 is a strip, 6 a fan
  constexpr std::int64_t kFan = 6;
  const auto mode_json = primitive.find("mode");
  const std::int64_t mode = mode_json ? mode_json->integer(0, kFan) : kTriangles;
  if (mode < kTriangles) return std::nullopt;
  JsonReader corners = positionsOf(primitive, accessors);
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

/// Which nodes the scene that is read reaches.
std::vector<bool> reachedNodes(const JsonReader& gltf, const std::vector<JsonReader>& nodes) {
  std::vector<bool> reached(nodes.size(), false);
  const auto scenes_json = gltf.find("scenes");
  if (!scenes_json) return reached;
  const std::vector<JsonReader> scenes = scenes_json->elements();
  const auto scene_json = gltf.find("scene");
  const std::int64_t scene =
      scene_json ? scene_json->integer(0, static_cast<std::int64_t>(scenes.size()) - 1) : 0;
  if (scenes.empty()) return reached;
  std::vector<JsonReader> open;
  const auto roots = scenes[static_cast<std::size_t>(scene)].find("nodes");
  if (roots) open = roots->elements();
  while (!open.empty()) {
    const auto index = static_cast<std::size_t>(
        open.back().integer(0, static_cast<std::int64_t>(nodes.size()) - 1));
    open.pop_back();
    reached[index] = true;
    if (const auto children = nodes[index].find("children"))
      for (const JsonReader& child : children->elements()) open.push_back(child);
  }
  return reached;
}

/// Which meshes the nodes of the scene show.
std::vector<bool> shownMeshes(const std::vector<JsonReader>& nodes,
                              const std::vector<bool>& reached, std::size_t meshes) {
  std::vector<bool> shown(meshes, false);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const auto mesh = nodes[i].find("mesh"); mesh && reached[i])
      shown[static_cast<std::size_t>(mesh->integer(0, static_cast<std::int64_t>(meshes) - 1))] =
          true;
  return shown;
}

bool isMorphed(const JsonReader& mesh) {
  return std::ranges::any_of(mesh.at("primitives").elements(),
                             [](const JsonReader& primitive) { return primitive.has("targets"); });
}

/// What importers leave out: copies, visibility, deformations.
struct GltfRest {
  std::int64_t instanced = 0;
  std::int64_t hidden = 0;
  std::int64_t skinned = 0;
  std::int64_t morphed = 0;
  std::int64_t unused = 0;  ///< meshes outside of the scene

  void addNode(const JsonReader& node) {
    if (node.has("mesh") && node.has("skin")) ++skinned;
    const auto extensions = node.find("extensions");
    if (!extensions) return;
    if (extensions->has("EXT_mesh_gpu_instancing")) ++instanced;
    if (const auto visibility = extensions->find("KHR_node_visibility"))
      if (const auto visible = visibility->find("visible"); visible && !visible->boolean())
        ++hidden;
  }
  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    const auto note = [&notes](std::int64_t count, const char* item, const char* what) {
      if (count > 0) notes.push_back(countText(count, item) + what);
    };
    note(instanced, "node",
         " with instances (EXT_mesh_gpu_instancing): only one instance was read");
    note(hidden, "hidden node", ": read as visible");
    note(skinned, "node", " with a skin: read without its deformation");
    note(morphed, "mesh part", " with morph targets: read without them");
    note(unused, "mesh part", " outside of the scene: left out");
    return notes;
  }
};

/// Importers leave out faces with bad indices; the count that the file declares shows it.
MeshDeclaration checkGltfJson(const std::filesystem::path& file, std::string_view text) {
  const JsonDocument document(file, text);
  const JsonReader gltf = document.root();
  MeshDeclaration declaration;
  const auto accessors = gltf.find("accessors");
  if (accessors && accessors->value().is_object())
    throw InputError(file, "is glTF 1.0: export the mesh as glTF 2.0");
  checkRequiredExtensions(gltf);
  checkBufferViews(gltf);
  const auto meshes = gltf.find("meshes");
  if (!accessors || !meshes) throw InputError(file, "the mesh has no faces");
  checkGltfNodes(gltf);
  const std::vector<JsonReader> all_accessors = accessors->elements();
  const std::vector<JsonReader> all_meshes = meshes->elements();
  const auto nodes_json = gltf.find("nodes");
  const std::vector<JsonReader> nodes =
      nodes_json ? nodes_json->elements() : std::vector<JsonReader>();
  const std::vector<bool> reached = reachedNodes(gltf, nodes);
  const std::vector<bool> shown = shownMeshes(nodes, reached, all_meshes.size());
  if (std::ranges::count(shown, true) == 0)
    throw InputError(file, "scene", "shows no mesh: export the mesh with a scene");
  GltfRest rest;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (reached[i]) rest.addNode(nodes[i]);
  std::int64_t triangles = 0;
  bool all_faces = true;
  for (std::size_t i = 0; i < all_meshes.size(); ++i) {
    if (!shown[i]) {
      ++rest.unused;
      continue;
    }
    if (isMorphed(all_meshes[i])) ++rest.morphed;
    for (const JsonReader& primitive : all_meshes[i].at("primitives").elements()) {
      const std::optional<std::int64_t> count = gltfTriangles(primitive, all_accessors);
      all_faces = all_faces && count.has_value();
      triangles += count.value_or(0);
    }
  }
  declaration.notes = rest.notes();
  if (!all_faces) return declaration;
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
      return checkPly(files.file, files.content());
    case MeshFormat::kStl:
      return checkStl(files.file, files.bytes);
    case MeshFormat::kGlb:
      return checkGlb(files.file, files.bytes);
    case MeshFormat::kGltf:
      return checkGltfJson(files.file, asText(files.bytes));
    case MeshFormat::kObj:
      return checkObj(files.file, asText(files.content()));
  }
  return {};
}

void noteOpenEnd(std::string_view text, MeshDeclaration& declaration) {
  if (!endsItsLine(text))
    declaration.notes.emplace_back(
        "the last line of the file has no line end: the file may be truncated");
}

std::span<const std::uint8_t> MeshFiles::content() const {
  if (format != MeshFormat::kPly && format != MeshFormat::kObj) return bytes;
  const std::string_view marked = asText(bytes);
  const std::string_view text =
      format == MeshFormat::kObj ? textOf(file, marked) : unmarkedText(file, marked);
  return Bytes(bytes).subspan(static_cast<std::size_t>(text.data() - marked.data()), text.size());
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
