// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Geometry>

namespace boresight::sessions {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell)
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15u + (hash >> 29);
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

/// Vertices kept so far, in cells wide enough that a tolerance box touches at most eight of them.
class VertexGrid {
 public:
  VertexGrid(float tolerance, std::size_t count) : tolerance_(tolerance) {
    cell_size_ = 8.0 * std::max(static_cast<double>(tolerance),
                                static_cast<double>(std::numeric_limits<float>::min()));
    cells_.reserve(count);
    next_.reserve(count);
  }

  /// The first kept vertex within the tolerance, or -1.
  std::int32_t find(const Eigen::Vector3f& vertex, const std::vector<Eigen::Vector3f>& kept) const {
    const Cell low = cellOf(vertex, -1.0);
    const Cell high = cellOf(vertex, 1.0);
    std::int32_t found = -1;
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto cell = cells_.find(Cell{x, y, z});
          if (cell == cells_.end()) continue;
          for (std::int32_t i = cell->second; i >= 0; i = next_[static_cast<std::size_t>(i)])
            if ((found < 0 || i < found) && near(vertex, kept[static_cast<std::size_t>(i)]))
              found = i;
        }
    return found;
  }

  /// `index` must grow by one from call to call.
  void insert(const Eigen::Vector3f& vertex, std::int32_t index) {
    const auto [cell, inserted] = cells_.try_emplace(cellOf(vertex, 0.0), index);
    next_.push_back(inserted ? -1 : cell->second);
    cell->second = index;
  }

 private:
  Cell cellOf(const Eigen::Vector3f& vertex, double direction) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = static_cast<double>(vertex[static_cast<Eigen::Index>(axis)]) +
                           direction * static_cast<double>(tolerance_);
      cell[axis] = static_cast<std::int64_t>(std::floor(place / cell_size_));
    }
    return cell;
  }

  bool near(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
    return (a - b).cwiseAbs().maxCoeff() <= tolerance_;
  }

  float tolerance_;
  double cell_size_ = 1.0;
  std::unordered_map<Cell, std::int32_t, CellHash> cells_;  ///< last vertex of the cell
  std::vector<std::int32_t> next_;                          ///< earlier vertex of the same cell
};

struct Corner {
  std::int32_t index = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Corners in a plane in which the polygon runs counter-clockwise: the coordinate along which its
/// area vector (Newell) is longest is left out.
std::vector<Corner> flatten(const std::vector<Eigen::Vector3f>& vertices,
                            std::span<const std::int32_t> indices) {
  const auto vertex = [&vertices, indices](std::size_t i) -> Eigen::Vector3d {
    return vertices[static_cast<std::size_t>(indices[i % indices.size()])].cast<double>();
  };
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < indices.size(); ++i)
    area += (vertex(i) - vertex(0)).cross(vertex(i + 1) - vertex(0));
  Eigen::Index dropped = 0;
  area.cwiseAbs().maxCoeff(&dropped);
  Eigen::Index first = (dropped + 1) % 3;
  Eigen::Index second = (dropped + 2) % 3;
  if (area[dropped] < 0.0) std::swap(first, second);
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < indices.size(); ++i)
    corners.push_back({indices[i], Eigen::Vector2d(vertex(i)[first], vertex(i)[second])});
  return corners;
}

/// Whether the corner between its neighbours turns left and no other corner lies in their triangle.
bool isEar(const std::vector<Corner>& corners, std::size_t at) {
  const std::size_t count = corners.size();
  const std::size_t before = (at + count - 1) % count;
  const std::size_t after = (at + 1) % count;
  const Eigen::Vector2d& a = corners[before].place;
  const Eigen::Vector2d& b = corners[at].place;
  const Eigen::Vector2d& c = corners[after].place;
  if (!(cross(a, b, c) > 0.0)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& p = corners[i].place;
    if (i == before || i == at || i == after || p == a || p == b || p == c) continue;
    if (cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0) return false;
  }
  return true;
}

/// A corner on the straight line of its neighbours takes no area: it is no ear, but may go once
/// nothing else can.
bool isStraight(const std::vector<Corner>& corners, std::size_t at) {
  const std::size_t count = corners.size();
  return cross(corners[(at + count - 1) % count].place, corners[at].place,
               corners[(at + 1) % count].place) == 0.0;
}

std::size_t findCorner(const std::vector<Corner>& corners,
                       bool (*suits)(const std::vector<Corner>&, std::size_t)) {
  std::size_t at = 0;
  while (at < corners.size() && !suits(corners, at)) ++at;
  return at;
}

void appendFan(std::span<const std::int32_t> corners, std::vector<Face>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    triangles.push_back({{corners[0], corners[i - 1], corners[i]}});
}

}  // namespace

float weldTolerance(const std::vector<Eigen::Vector3f>& vertices) {
  float largest = 0.0F;
  for (const Eigen::Vector3f& vertex : vertices)
    largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  return 2.0F * std::numeric_limits<float>::epsilon() * largest;
}

WeldedMesh weldMesh(const std::vector<Eigen::Vector3f>& vertices, const std::vector<Face>& faces) {
  WeldedMesh welded;
  std::vector<std::int32_t> used_as(vertices.size(), -1);
  VertexGrid grid(weldTolerance(vertices), vertices.size());
  std::int64_t used = 0;
  const auto weld = [&](std::int32_t old_index) {
    std::int32_t& index = used_as[static_cast<std::size_t>(old_index)];
    if (index >= 0) return index;
    ++used;
    const Eigen::Vector3f& vertex = vertices[static_cast<std::size_t>(old_index)];
    index = grid.find(vertex, welded.vertices);
    if (index >= 0) {
      ++welded.merged_vertices;
      return index;
    }
    index = static_cast<std::int32_t>(welded.vertices.size());
    grid.insert(vertex, index);
    welded.vertices.push_back(vertex);
    return index;
  };
  welded.faces.reserve(faces.size());
  for (const Face& face : faces) {
    Face corner;
    for (std::size_t i = 0; i < 3; ++i) corner.vertex[i] = weld(face.vertex[i]);
    const auto& v = corner.vertex;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
      ++welded.collapsed_faces;
    else
      welded.faces.push_back(corner);
  }
  welded.unused_vertices = static_cast<std::int64_t>(vertices.size()) - used;
  return welded;
}

bool triangulatePolygon(const std::vector<Eigen::Vector3f>& vertices,
                        std::span<const std::int32_t> corners, std::vector<Face>& triangles) {
  if (corners.size() == 3) {
    appendFan(corners, triangles);
    return true;
  }
  // Ear clipping takes up to n^3 steps, which only a damaged file makes long.
  constexpr std::size_t kMaxCorners = 1000;
  if (corners.size() > kMaxCorners) {
    appendFan(corners, triangles);
    return false;
  }
  const std::size_t triangles_before = triangles.size();
  std::vector<Corner> rest = flatten(vertices, corners);
  while (rest.size() > 3) {
    std::size_t at = findCorner(rest, isEar);
    if (at == rest.size()) at = findCorner(rest, isStraight);
    if (at == rest.size()) {
      triangles.resize(triangles_before);
      appendFan(corners, triangles);
      return false;
    }
    const std::size_t count = rest.size();
    triangles.push_back(
        {{rest[(at + count - 1) % count].index, rest[at].index, rest[(at + 1) % count].index}});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles.push_back({{rest[0].index, rest[1].index, rest[2].index}});
  return true;
}

}  // namespace boresight::sessions
