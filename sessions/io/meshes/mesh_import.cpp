// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>
#include <Eigen/LU>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/io/meshes/mesh_faces.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/io/meshes/obj_file.h"
#include "sessions/io/meshes/ply_file.h"
#include "sessions/io/meshes/stl_file.h"

#if defined(__SANITIZE_ADDRESS__)
// Importers of assimp leak when they reject a file; our own leaks must still be reported.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }  // NOLINT
#endif

namespace boresight::sessions {
namespace {

constexpr double kMaxCoordinate_m = 1e6;

/// The files of a mesh, under the names by which an importer opens them, and no others.
class MemoryFiles final : public Assimp::IOSystem {
 public:
  MemoryFiles(const MeshFiles& files, std::span<const std::uint8_t> mesh) {
    for (const MeshBuffer& buffer : files.buffers) files_[buffer.uri] = buffer.bytes;
    files_[files.file.filename()] = mesh;
  }
  bool Exists(const char* name) const override { return files_.contains(name); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    const auto found = files_.find(name);
    if (found == files_.end()) return nullptr;
    return new Assimp::MemoryIOStream(found->second.data(), found->second.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::map<std::string, std::span<const std::uint8_t>, std::less<>> files_;
};

/// Importers of other formats would try to read what the format's own does not recognize.
void keepImportersOf(MeshFormat format, Assimp::Importer& importer) {
  const std::string extension = lowerCase(meshFormatName(format));
  for (std::size_t i = importer.GetImporterCount(); i > 0; --i) {
    Assimp::BaseImporter* other = importer.GetImporter(i - 1);
    std::set<std::string> extensions;
    other->GetExtensionList(extensions);
    if (extensions.contains(extension)) continue;
    importer.UnregisterLoader(other);
    delete other;  // NOLINT: the importer gave it up
  }
}

using Json = nlohmann::json;
using Keys = std::initializer_list<const char*>;

Json kept(const Json& object, Keys keys) {
  Json gltf = Json::object();
  for (const char* key : keys)
    if (object.contains(key)) gltf[key] = object[key];
  return gltf;
}

void keepInEach(Json& object, const char* list, Keys keys) {
  if (!object.contains(list)) return;
  for (Json& gltf : object[list]) gltf = kept(gltf, keys);
}

std::string geometryJson(const std::filesystem::path& file, std::string_view text) {
  Json gltf = kept(Json::parse(textOf(file, text)), {"asset", "scene", "scenes", "nodes", "meshes",
                                                     "accessors", "bufferViews", "buffers"});
  keepInEach(gltf, "scenes", {"nodes"});
  keepInEach(gltf, "nodes", {"children", "mesh", "matrix", "translation", "rotation", "scale"});
  keepInEach(gltf, "meshes", {"primitives"});
  for (Json& mesh : gltf["meshes"]) {
    keepInEach(mesh, "primitives", {"attributes", "indices", "mode"});
    for (Json& primitive : mesh["primitives"])
      primitive["attributes"] = kept(primitive["attributes"], {"POSITION"});
  }
  keepInEach(gltf, "accessors", {"bufferView", "byteOffset", "componentType", "count", "type"});
  keepInEach(gltf, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"});
  keepInEach(gltf, "buffers", {"uri", "byteLength"});
  return gltf.dump();
}

void appendNumber(std::vector<std::uint8_t>& bytes, std::size_t number) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

/// A .gltf or .glb file with its geometry alone: nodes, triangles and where their numbers are.
/// Importers read, and crash on, the rest (skins, animations, images, extensions), of which nothing
/// is used. The files passed checkMeshContainer.
std::vector<std::uint8_t> gltfGeometry(const MeshFiles& files) {
  const std::span<const std::uint8_t> bytes = files.bytes;
  if (files.format == MeshFormat::kGltf) {
    const std::string text = geometryJson(files.file, asText(bytes));
    return {text.begin(), text.end()};
  }
  constexpr std::size_t kHeader = 20;
  const auto old_size = static_cast<std::size_t>(readUnsigned(bytes, 12, 4, false));
  std::string text = geometryJson(files.file, asText(bytes.subspan(kHeader, old_size)));
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto rest = bytes.subspan(kHeader + old_size);
  std::vector<std::uint8_t> result(bytes.begin(), bytes.begin() + 8);
  appendNumber(result, kHeader + text.size() + rest.size());
  appendNumber(result, text.size());
  result.insert(result.end(), bytes.begin() + 16, bytes.begin() + kHeader);
  result.insert(result.end(), text.begin(), text.end());
  result.insert(result.end(), rest.begin(), rest.end());
  return result;
}

/// What the importer gets in place of the mesh's file. It takes a first data byte of 10 for the
/// second half of a PLY header's line end and drops it, which moves all that follows: it gets one
/// more to drop.
std::vector<std::uint8_t> rewrittenFor(const MeshFiles& files, const MeshDeclaration& declared) {
  if (carriesUnit(files.format)) return gltfGeometry(files);
  if (files.format == MeshFormat::kStl) return plainStl(files.file, files.bytes);
  const std::span<const std::uint8_t> content = files.content();
  if (files.format == MeshFormat::kObj) return plainObj(asText(content));
  if (declared.needs_plain_ply) return plainPly(files.file, content);
  std::vector<std::uint8_t> longer(content.begin(), content.end());
  if (!declared.newline_as_data) return longer;
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(*declared.newline_as_data), '\n');
  return longer;
}

/// The importer's scene, polygons as they are in the file.
const aiScene* import(Assimp::Importer& importer, const MeshFiles& files,
                      std::span<const std::uint8_t> mesh) {
  const aiScene* scene = nullptr;
  std::string problem;
  try {
    keepImportersOf(files.format, importer);
    importer.SetIOHandler(new MemoryFiles(files, mesh));  // NOLINT: the importer's own
    scene = importer.ReadFile(files.file.filename().string(), 0);
    problem = importer.GetErrorString();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(files.file, std::string("not a readable ") + meshFormatName(files.format) +
                                     " mesh" + (problem.empty() ? "" : ": " + problem));
  return scene;
}

/// The importer passes on indices as they are in the file, some of which do not exist in a damaged
/// one.
void checkIndices(const std::filesystem::path& file, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mVertices == nullptr || (mesh.mFaces == nullptr && mesh.mNumFaces > 0))
      throw InputError(file, "the mesh has no vertices");
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned i = 0; i < mesh.mFaces[f].mNumIndices; ++i)
        if (mesh.mFaces[f].mIndices[i] >= mesh.mNumVertices)
          throw InputError(file, "face " + std::to_string(f),
                           "vertex " + std::to_string(mesh.mFaces[f].mIndices[i]) +
                               " does not exist (there are " + std::to_string(mesh.mNumVertices) +
                               ")");
  }
}

void countPrimitives(const aiScene& scene, const MeshDeclaration& declared, MeshInfo& info) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    info.file_vertices += scene.mMeshes[m]->mNumVertices;
    info.file_polygons += scene.mMeshes[m]->mNumFaces;
  }
  requireAtMost(info.file, info.file_vertices, kMaxMeshVertices, "vertices");
  if (declared.polygon_count && info.file_polygons < *declared.polygon_count)
    throw InputError(info.file, "faces",
                     std::to_string(*declared.polygon_count) + " declared, " +
                         std::to_string(info.file_polygons) + " readable");
}

Eigen::Matrix4d toEigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return matrix;
}

Eigen::Vector3f placedVertex(const std::filesystem::path& file, const aiVector3D& vertex,
                             const Eigen::Matrix4d& metres_from_mesh, std::int64_t index) {
  const Eigen::Vector4d raw(vertex.x, vertex.y, vertex.z, 1.0);
  const Eigen::Vector3d placed_m = (metres_from_mesh * raw).head<3>();
  if (!placed_m.allFinite())
    throw InputError(file, "vertex " + std::to_string(index), "not a finite number");
  if (placed_m.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
    throw InputError(file, "vertex " + std::to_string(index),
                     "is more than 1000 km from the origin: check the unit");
  return placed_m.cast<float>();
}

void appendFaces(const aiMesh& imported, std::int32_t first, bool mirrored, Mesh& mesh) {
  std::vector<std::int32_t> corners;
  for (unsigned f = 0; f < imported.mNumFaces; ++f) {
    const aiFace& polygon = imported.mFaces[f];
    if (polygon.mNumIndices < 3) {
      ++mesh.info.lines_and_points;
      continue;
    }
    corners.clear();
    for (unsigned i = 0; i < polygon.mNumIndices; ++i)
      corners.push_back(first + static_cast<std::int32_t>(polygon.mIndices[i]));
    // A mirrored node would turn its faces inside out.
    if (mirrored) std::reverse(corners.begin(), corners.end());
    if (!triangulatePolygon(mesh.vertices_m, corners, mesh.faces)) ++mesh.info.irregular_polygons;
  }
}

void appendMesh(const aiMesh& imported, const Eigen::Matrix4d& metres_from_mesh, Mesh& mesh) {
  const std::filesystem::path& file = mesh.info.file;
  const std::size_t first = mesh.vertices_m.size();
  requireAtMost(file, static_cast<std::int64_t>(first) + imported.mNumVertices, kMaxMeshVertices,
                "vertices");
  for (unsigned v = 0; v < imported.mNumVertices; ++v)
    mesh.vertices_m.push_back(placedVertex(file, imported.mVertices[v], metres_from_mesh, v));
  const bool mirrored = metres_from_mesh.topLeftCorner<3, 3>().determinant() < 0.0;
  appendFaces(imported, static_cast<std::int32_t>(first), mirrored, mesh);
  requireAtMost(file, static_cast<std::int64_t>(mesh.faces.size()), kMaxMeshFaces, "triangles");
}

/// All meshes of all nodes, placed by their nodes' transforms.
void placeNodes(const aiScene& scene, Mesh& mesh) {
  Eigen::Matrix4d metres_from_root = Eigen::Matrix4d::Identity();
  metres_from_root.topLeftCorner<3, 3>() *= mesh.info.metres_per_unit;
  std::vector<std::pair<const aiNode*, Eigen::Matrix4d>> open = {
      {scene.mRootNode, metres_from_root}};
  while (!open.empty()) {
    const auto [node, metres_from_parent] = open.back();
    open.pop_back();
    const Eigen::Matrix4d metres_from_node = metres_from_parent * toEigen(node->mTransformation);
    for (unsigned m = 0; m < node->mNumMeshes; ++m)
      appendMesh(*scene.mMeshes[node->mMeshes[m]], metres_from_node, mesh);
    for (unsigned c = node->mNumChildren; c > 0; --c)
      open.emplace_back(node->mChildren[c - 1], metres_from_node);
  }
}

}  // namespace

void requireAtMost(const std::filesystem::path& file, std::int64_t count, std::int64_t limit,
                   const char* what) {
  if (count > limit)
    throw InputError(file, what,
                     std::to_string(count) + " exceed the limit of " + std::to_string(limit) +
                         ": decimate the mesh");
}

void importMesh(const MeshFiles& files, const MeshDeclaration& declared, Mesh& mesh) {
  const std::vector<std::uint8_t> rewritten = rewrittenFor(files, declared);
  Assimp::Importer importer;
  const aiScene* scene = import(importer, files, rewritten);
  checkIndices(files.file, *scene);
  countPrimitives(*scene, declared, mesh.info);
  placeNodes(*scene, mesh);
}

}  // namespace boresight::sessions
