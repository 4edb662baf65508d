// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tests/support/box_mesh.h"

/// Small mesh files made by hand, so that the readers are not tested with their own writer.
namespace boresight::test {

struct PolygonMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::vector<std::int32_t>> polygons;
};

/// A cube of edge 2 around (0, 0, 10) with six quads, counter-clockwise seen from outside.
inline PolygonMesh cube() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back((boxCorner({1, 1, 1}, i) + Eigen::Vector3d(0, 0, 10)).cast<float>());
  for (const auto& quad : kBoxQuads) mesh.polygons.emplace_back(std::begin(quad), std::end(quad));
  return mesh;
}

inline std::string numbersOf(const Eigen::Vector3f& v, const char* between = " ") {
  return std::to_string(v.x()) + between + std::to_string(v.y()) + between + std::to_string(v.z());
}

/// The indices, each behind a blank.
inline std::string numbersOf(const std::vector<std::int32_t>& polygon, std::int32_t shift = 0) {
  std::string text;
  for (const std::int32_t index : polygon) text += " " + std::to_string(index + shift);
  return text;
}

template <class T>
void appendNumber(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  const bool swap = big_endian == (std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[swap ? sizeof(T) - 1 - i : i];
}

inline std::string plyHeader(const std::string& encoding, std::size_t vertices, std::size_t faces) {
  return "ply\nformat " + encoding + " 1.0\ncomment made by hand\nelement vertex " +
         std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string asciiPly(const PolygonMesh& mesh) {
  std::string text = plyHeader("ascii", mesh.vertices.size(), mesh.polygons.size());
  for (const Eigen::Vector3f& v : mesh.vertices) text += numbersOf(v) + "\n";
  for (const auto& polygon : mesh.polygons)
    text += std::to_string(polygon.size()) + numbersOf(polygon) + "\n";
  return text;
}

inline std::string binaryPly(const PolygonMesh& mesh, bool big_endian) {
  std::string bytes = plyHeader(big_endian ? "binary_big_endian" : "binary_little_endian",
                                mesh.vertices.size(), mesh.polygons.size());
  for (const Eigen::Vector3f& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) appendNumber(bytes, v[axis], big_endian);
  for (const auto& polygon : mesh.polygons) {
    bytes += static_cast<char>(polygon.size());
    for (const std::int32_t index : polygon) appendNumber(bytes, index, big_endian);
  }
  return bytes;
}

inline std::string obj(const PolygonMesh& mesh) {
  std::string text = "# made by hand\n";
  for (const Eigen::Vector3f& v : mesh.vertices) text += "v " + numbersOf(v) + "\n";
  for (const auto& polygon : mesh.polygons) text += "f" + numbersOf(polygon, 1) + "\n";
  return text;
}

/// Fans; STL has triangles only.
inline std::vector<std::array<Eigen::Vector3f, 3>> triangles(const PolygonMesh& mesh) {
  std::vector<std::array<Eigen::Vector3f, 3>> all;
  for (const auto& polygon : mesh.polygons)
    for (std::size_t i = 2; i < polygon.size(); ++i)
      all.push_back({mesh.vertices[static_cast<std::size_t>(polygon[0])],
                     mesh.vertices[static_cast<std::size_t>(polygon[i - 1])],
                     mesh.vertices[static_cast<std::size_t>(polygon[i])]});
  return all;
}

inline std::string binaryStl(const PolygonMesh& mesh, const std::string& header = "by hand") {
  const auto all = triangles(mesh);
  std::string bytes = header;
  bytes.resize(80, ' ');
  appendNumber(bytes, static_cast<std::uint32_t>(all.size()), false);
  for (const auto& triangle : all) {
    for (int i = 0; i < 3; ++i) appendNumber(bytes, 0.0F, false);
    for (const Eigen::Vector3f& v : triangle)
      for (int axis = 0; axis < 3; ++axis) appendNumber(bytes, v[axis], false);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline std::string asciiStl(const PolygonMesh& mesh) {
  std::string text = "solid cube\n";
  for (const auto& triangle : triangles(mesh)) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Eigen::Vector3f& v : triangle) text += "vertex " + numbersOf(v) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

/// Positions, then 32-bit indices: the buffer of the glTF files below.
inline std::string gltfBuffer(const PolygonMesh& mesh, std::size_t* index_count = nullptr) {
  std::string bytes;
  for (const Eigen::Vector3f& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) appendNumber(bytes, v[axis], false);
  const std::size_t positions = bytes.size();
  for (const auto& polygon : mesh.polygons)
    for (std::size_t i = 2; i < polygon.size(); ++i)
      for (const std::size_t corner : {std::size_t{0}, i - 1, i})
        appendNumber(bytes, static_cast<std::uint32_t>(polygon[corner]), false);
  if (index_count != nullptr) *index_count = (bytes.size() - positions) / 4;
  return bytes;
}

inline constexpr const char* kOneNode = R"([{"mesh":0}])";

/// `nodes` is the JSON text of the node list; node 0 is the scene's root, mesh 0 the mesh.
inline std::string gltf(const PolygonMesh& mesh, const std::string& nodes,
                        const std::string& uri_member) {
  std::size_t index_count = 0;
  const std::size_t size = gltfBuffer(mesh, &index_count).size();
  const std::string positions = std::to_string(12 * mesh.vertices.size());
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& v : mesh.vertices) box.extend(v);
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)" +
         R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
         std::to_string(mesh.vertices.size()) + R"(,"min":)" + "[" + numbersOf(box.min(), ",") + "]" +
         R"(,"max":)" + "[" + numbersOf(box.max(), ",") + "]" +
         R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
         std::to_string(index_count) +
         R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" + positions +
         R"(},{"buffer":0,"byteOffset":)" + positions + R"(,"byteLength":)" +
         std::to_string(4 * index_count) + R"(}],"buffers":[{)" + uri_member + R"("byteLength":)" +
         std::to_string(size) + "}]}";
}

/// A chunk of a GLB file, for instance of the type "JSON".
inline std::string glbChunk(const std::string& type, const std::string& content) {
  std::string bytes;
  appendNumber(bytes, static_cast<std::uint32_t>(content.size()), false);
  return bytes + type + content;
}

inline std::string glbFile(std::string json, const std::string& further_chunks) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string chunks = glbChunk("JSON", json) + further_chunks;
  std::string bytes = "glTF";
  appendNumber(bytes, std::uint32_t{2}, false);
  appendNumber(bytes, static_cast<std::uint32_t>(12 + chunks.size()), false);
  return bytes + chunks;
}

inline std::string glb(const PolygonMesh& mesh, const std::string& nodes = kOneNode) {
  return glbFile(gltf(mesh, nodes, ""), glbChunk(std::string("BIN\0", 4), gltfBuffer(mesh)));
}

}  // namespace boresight::test
