// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include "core/base/digest.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_document.h"
#include "sessions/io/mesh_container.h"
#include "sessions/io/mesh_weld.h"

namespace boresight::sessions {
namespace {

constexpr double kMaxCoordinate_m = 1e6;
constexpr double kSliverRatio = 1e-4;

struct Triangles {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<Face> faces;
};

[[noreturn]] void tooMany(const std::filesystem::path& file, std::int64_t count, const char* what,
                          std::int64_t limit) {
  throw InputError(file, what,
                   std::to_string(count) + " exceed the limit of " + std::to_string(limit) +
                       ": decimate the mesh");
}

double unitScale(const std::filesystem::path& file, MeshFormat format, const std::string& unit,
                 std::string& used_unit) {
  used_unit = unit;
  if (unit.empty()) {
    if (!carriesUnit(format))
      throw InputError(file, "mesh_unit",
                       std::string("missing: ") + meshFormatName(format) +
                           " carries no unit (m, cm, mm, um, in, ...)");
    used_unit = "m";
  }
  const std::optional<double> scale = metresPerUnit(used_unit);
  if (!scale)
    throw InputError(file, "mesh_unit",
                     "unknown unit '" + unit + "' (m, dm, cm, mm, um, in, ft, yd, km)");
  return *scale;
}

/// The importer's scene, polygons as they are in the file.
const aiScene* import(Assimp::Importer& importer, const std::filesystem::path& file,
                      const std::vector<std::uint8_t>& bytes, MeshFormat format) {
  const aiScene* scene = nullptr;
  std::string problem;
  try {
    // glTF refers to buffers beside it, so it needs the path; the others come from what was hashed.
    if (format == MeshFormat::kGltf) {
      scene = importer.ReadFile(file.string(), 0);
    } else {
      const std::string hint = file.extension().string().substr(1);
      scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, hint.c_str());
    }
    problem = importer.GetErrorString();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(file, std::string("not a readable ") + meshFormatName(format) + " mesh" +
                               (problem.empty() ? "" : ": " + problem));
  return scene;
}

/// The importer passes on indices as they are in the file, and its triangulation trusts them.
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

std::int64_t triangleCountOf(const aiScene& scene) {
  std::int64_t count = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
      count += std::max(0, static_cast<int>(scene.mMeshes[m]->mFaces[f].mNumIndices) - 2);
  return count;
}

void countPrimitives(const std::filesystem::path& file, const aiScene& scene,
                     const MeshDeclaration& declared, MeshInfo& info) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    info.file_vertices += scene.mMeshes[m]->mNumVertices;
    info.file_polygons += scene.mMeshes[m]->mNumFaces;
  }
  if (info.file_vertices > kMaxMeshVertices)
    tooMany(file, info.file_vertices, "vertices", kMaxMeshVertices);
  if (declared.polygon_count && info.file_polygons < *declared.polygon_count)
    throw InputError(file, "faces",
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
                     "is more than 1000 km from the origin: is the unit right?");
  return placed_m.cast<float>();
}

void appendMesh(const std::filesystem::path& file, const aiMesh& mesh,
                const Eigen::Matrix4d& metres_from_mesh, Triangles& triangles, MeshInfo& info) {
  const auto first = static_cast<std::int32_t>(triangles.vertices_m.size());
  if (first + static_cast<std::int64_t>(mesh.mNumVertices) > kMaxMeshVertices)
    tooMany(file, first + static_cast<std::int64_t>(mesh.mNumVertices), "vertices",
            kMaxMeshVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    triangles.vertices_m.push_back(placedVertex(file, mesh.mVertices[v], metres_from_mesh, v));
  const bool mirrored = metres_from_mesh.topLeftCorner<3, 3>().determinant() < 0.0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& polygon = mesh.mFaces[f];
    if (polygon.mNumIndices != 3) {
      ++info.lines_and_points;
      continue;
    }
    Face face;
    for (unsigned i = 0; i < 3; ++i) {
      face.vertex[i] = first + static_cast<std::int32_t>(polygon.mIndices[i]);
    }
    // A mirrored node would turn its faces inside out.
    if (mirrored) std::swap(face.vertex[1], face.vertex[2]);
    triangles.faces.push_back(face);
  }
  if (static_cast<std::int64_t>(triangles.faces.size()) > kMaxMeshFaces)
    tooMany(file, static_cast<std::int64_t>(triangles.faces.size()), "triangles", kMaxMeshFaces);
}

/// All meshes of all nodes, placed by their nodes' transforms.
Triangles placeNodes(const std::filesystem::path& file, const aiScene& scene, double scale,
                     MeshInfo& info) {
  Triangles triangles;
  Eigen::Matrix4d metres_from_root = Eigen::Matrix4d::Identity();
  metres_from_root.topLeftCorner<3, 3>() *= scale;
  std::vector<std::pair<const aiNode*, Eigen::Matrix4d>> open = {
      {scene.mRootNode, metres_from_root}};
  while (!open.empty()) {
    const auto [node, metres_from_parent] = open.back();
    open.pop_back();
    const Eigen::Matrix4d metres_from_node = metres_from_parent * toEigen(node->mTransformation);
    for (unsigned m = 0; m < node->mNumMeshes; ++m)
      appendMesh(file, *scene.mMeshes[node->mMeshes[m]], metres_from_node, triangles, info);
    for (unsigned c = node->mNumChildren; c > 0; --c)
      open.emplace_back(node->mChildren[c - 1], metres_from_node);
  }
  return triangles;
}

double edgeLength(const Mesh& mesh, std::int32_t a, std::int32_t b) {
  return (mesh.vertices_m[static_cast<std::size_t>(a)] -
          mesh.vertices_m[static_cast<std::size_t>(b)])
      .cast<double>()
      .norm();
}

void measure(const std::filesystem::path& file, Mesh& mesh) {
  MeshInfo& info = mesh.info;
  info.minimum_m = info.maximum_m = mesh.vertices_m.front().cast<double>();
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    info.minimum_m = info.minimum_m.cwiseMin(vertex.cast<double>());
    info.maximum_m = info.maximum_m.cwiseMax(vertex.cast<double>());
  }
  std::vector<double> lengths_m;
  lengths_m.reserve(3 * mesh.faces.size());
  for (const Face& face : mesh.faces) {
    const auto corner = [&mesh, &face](std::size_t i) -> Eigen::Vector3d {
      return mesh.vertices_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
    };
    double longest_m = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      lengths_m.push_back(edgeLength(mesh, face.vertex[i], face.vertex[(i + 1) % 3]));
      longest_m = std::max(longest_m, lengths_m.back());
    }
    const double doubled_area_m2 = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    info.area_m2 += 0.5 * doubled_area_m2;
    if (doubled_area_m2 <= kSliverRatio * longest_m * longest_m) ++info.sliver_faces;
  }
  if (info.sliver_faces == static_cast<std::int64_t>(mesh.faces.size()))
    throw InputError(file, "faces",
                     "all " + std::to_string(info.sliver_faces) + " are slivers without a surface");
  const auto middle = lengths_m.begin() + static_cast<std::ptrdiff_t>(lengths_m.size() / 2);
  std::nth_element(lengths_m.begin(), middle, lengths_m.end());
  info.median_edge_m = *middle;
  info.shortest_edge_m = *std::min_element(lengths_m.begin(), lengths_m.end());
  info.longest_edge_m = *std::max_element(lengths_m.begin(), lengths_m.end());
}

/// Hash of a .gltf together with the buffers it names, which hold the geometry.
std::string hashWithBuffers(const std::filesystem::path& file,
                            const std::vector<std::uint8_t>& bytes, MeshFormat format) {
  if (format != MeshFormat::kGltf) return sha256Text(bytes);
  Sha256 sha;
  sha.update(bytes);
  const JsonDocument document(file, asText(bytes));
  if (const auto buffers = document.root().find("buffers"))
    for (const JsonReader& buffer : buffers->elements())
      if (const auto uri = buffer.find("uri"); uri && !uri->text().starts_with("data:"))
        sha.update(readFileBytes(uri->path(), kMaxMeshFileBytes));
  return hexText(sha.digest()).data();
}

}  // namespace

std::string lengthText(double length_m) {
  char buffer[48];
  if (length_m < 1.0)
    std::snprintf(buffer, sizeof(buffer), "%.4g mm", 1000.0 * length_m);
  else
    std::snprintf(buffer, sizeof(buffer), "%.4g m", length_m);
  return buffer;
}

std::optional<double> metresPerUnit(const std::string& unit) {
  constexpr std::pair<const char*, double> kUnits[] = {
      {"m", 1.0},     {"dm", 0.1},    {"cm", 0.01},   {"mm", 0.001},  {"um", 1e-6},
      {"in", 0.0254}, {"ft", 0.3048}, {"yd", 0.9144}, {"km", 1000.0},
  };
  for (const auto& [name, scale] : kUnits)
    if (unit == name) return scale;
  return std::nullopt;
}

Mesh readMesh(const std::filesystem::path& file, const std::string& unit) {
  Mesh mesh;
  MeshInfo& info = mesh.info;
  const MeshFormat format = meshFormatOf(file);
  info.file = file;
  info.format = meshFormatName(format);
  info.metres_per_unit = unitScale(file, format, unit, info.unit);
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxMeshFileBytes);
  const MeshDeclaration declared = checkMeshContainer(file, bytes, format);
  if (declared.vertex_count.value_or(0) > kMaxMeshVertices)
    tooMany(file, *declared.vertex_count, "vertices", kMaxMeshVertices);
  if (declared.polygon_count.value_or(0) > kMaxMeshFaces)
    tooMany(file, *declared.polygon_count, "faces", kMaxMeshFaces);
  if (declared.polygon_count.value_or(1) == 0 || (declared.vertex_count && !declared.polygon_count))
    throw InputError(file, "the mesh has no faces (a point cloud cannot be rendered)");
  info.file_sha256 = hashWithBuffers(file, bytes, format);

  Assimp::Importer importer;
  const aiScene* scene = import(importer, file, bytes, format);
  checkIndices(file, *scene);
  countPrimitives(file, *scene, declared, info);
  const std::int64_t expected_triangles = triangleCountOf(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) throw InputError(file, "the mesh cannot be triangulated");
  info.lost_triangles = std::max<std::int64_t>(0, expected_triangles - triangleCountOf(*scene));

  const Triangles triangles = placeNodes(file, *scene, info.metres_per_unit, info);
  if (triangles.faces.empty())
    throw InputError(file, "the mesh has no faces (a point cloud cannot be rendered)");
  WeldedMesh welded = weldMesh(triangles.vertices_m, triangles.faces);
  if (welded.faces.empty())
    throw InputError(file, "faces", "each has two corners in the same point: no surface");
  mesh.vertices_m = std::move(welded.vertices);
  mesh.faces = std::move(welded.faces);
  info.merged_vertices = welded.merged_vertices;
  info.unused_vertices = welded.unused_vertices;
  info.collapsed_faces = welded.collapsed_faces;
  measure(file, mesh);
  return mesh;
}

std::vector<std::string> MeshInfo::notes() const {
  std::vector<std::string> all;
  const auto count = [&all](std::int64_t number, const char* what) {
    if (number > 0) all.push_back(std::to_string(number) + " " + what);
  };
  count(unused_vertices, "vertices belong to no face and were left out");
  count(collapsed_faces, "faces have two corners in the same point and were left out");
  count(lines_and_points, "lines and points were left out");
  count(lost_triangles, "triangles of polygons with holes or crossings were lost");
  count(sliver_faces, "faces are slivers");
  constexpr double kUnusuallyLarge_m = 20.0;
  constexpr double kUnusuallySmall_m = 0.002;
  if (diagonal_m() > kUnusuallyLarge_m || diagonal_m() < kUnusuallySmall_m)
    all.push_back("the mesh measures " + lengthText(diagonal_m()) +
                  " across: is its unit really '" + unit + "'?");
  return all;
}

}  // namespace boresight::sessions
