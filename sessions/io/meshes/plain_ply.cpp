// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/meshes/ply_file.h"

namespace boresight::sessions {
namespace {

using Polygon = std::vector<std::int32_t>;

struct PlyMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<Polygon> polygons;
};

/// What is no index of a vertex is one that does not exist; negative numbers are -1.
std::int32_t indexOf(double value) {
  constexpr double kNone = 2147483647.0;
  return static_cast<std::int32_t>(value >= -1.0 && value <= kNone ? value
                                   : value < -1.0                  ? -1.0
                                                                   : kNone);
}

/// Triangles of strips; -1 ends a strip. Every second triangle is turned. Triangles without area
/// join two parts of a strip.
void addStrips(const Polygon& strip, std::vector<Polygon>& polygons) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] < 0) first = i + 1;
    if (strip[i] < 0 || i < first + 2) continue;
    Polygon triangle = {strip[i - 2], strip[i - 1], strip[i]};
    if ((i - first) % 2 == 1) std::swap(triangle[0], triangle[1]);
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      polygons.push_back(triangle);
  }
}

void takeItem(const PlyElement& element, std::uint64_t item, PlyValues& values, PlyMesh& mesh) {
  std::array<double, 3> vertex{};
  for (const PlyProperty& property : element.properties) {
    const std::uint64_t count = values.count(element, item, property);
    if (!isGeometry(element, property)) {
      values.skip(count, property.type);
      continue;
    }
    Polygon list;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = values.next(property.type);
      if (isCoordinate(property))
        vertex[static_cast<std::size_t>(property.name[0] - 'x')] = value;
      else
        list.push_back(indexOf(value));
    }
    if (element.name == "face") mesh.polygons.push_back(list);
    if (element.name == "tristrips") addStrips(list, mesh.polygons);
  }
  if (element.name == "vertex") mesh.vertices.push_back(vertex);
}

template <class T>
void append(T value, std::vector<std::uint8_t>& bytes) {
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::little)
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  else
    bytes.insert(bytes.end(), raw.rbegin(), raw.rend());
}

std::vector<std::uint8_t> written(const PlyMesh& mesh) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.polygons.size()) + "\nproperty list int int vertex_indices\nend_header\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  // The importer drops a first byte of 10: see MeshDeclaration::newline_as_data.
  const std::size_t body = bytes.size();
  for (const auto& vertex : mesh.vertices)
    for (const double value : vertex) append(value, bytes);
  for (const Polygon& polygon : mesh.polygons) {
    append(static_cast<std::int32_t>(polygon.size()), bytes);
    for (const std::int32_t index : polygon) append(index, bytes);
  }
  if (body < bytes.size() && bytes[body] == '\n')
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(body), '\n');
  return bytes;
}

}  // namespace

bool needsPlainPly(const PlyHeader& header) {
  const auto placeOf = [&](const char* name) {
    return std::find_if(header.elements.begin(), header.elements.end(),
                        [&](const PlyElement& element) { return element.name == name; });
  };
  const auto strips = placeOf("tristrips");
  const auto faces = placeOf("face");
  return (strips != header.elements.end() && strips->count > 0) ||
         (faces != header.elements.end() && faces < placeOf("vertex"));
}

std::vector<std::uint8_t> plainPly(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes) {
  const PlyHeader header = readPlyHeader(file, bytes);
  PlyValues values(file, header, bytes);
  PlyMesh mesh;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      takeItem(element, i, values, mesh);
  return written(mesh);
}

}  // namespace boresight::sessions
