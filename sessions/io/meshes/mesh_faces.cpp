// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

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

/// The first ear: a corner that turns left, without another corner in the triangle with its
/// neighbours. Else the first corner on the straight line of its neighbours, which takes no area;
/// else the number of corners.
std::size_t cornerToClip(const std::vector<Corner>& corners) {
  const std::size_t count = corners.size();
  std::size_t straight = count;
  for (std::size_t at = 0; at < count; ++at) {
    const Eigen::Vector2d& a = corners[(at + count - 1) % count].place;
    const Eigen::Vector2d& b = corners[at].place;
    const Eigen::Vector2d& c = corners[(at + 1) % count].place;
    const auto is_inside = [&a, &b, &c](const Corner& corner) {
      const Eigen::Vector2d& p = corner.place;
      return p != a && p != b && p != c && cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 &&
             cross(c, a, p) >= 0.0;
    };
    const double turn = cross(a, b, c);
    if (turn > 0.0 && std::none_of(corners.begin(), corners.end(), is_inside)) return at;
    if (turn == 0.0 && straight == count) straight = at;
  }
  return straight;
}

/// The triangles of the clipped ears; none of a polygon that crosses itself or has no area.
std::vector<Face> earsOf(const std::vector<Eigen::Vector3f>& vertices,
                         std::span<const std::int32_t> corners) {
  std::vector<Face> triangles;
  std::vector<Corner> rest = flatten(vertices, corners);
  while (rest.size() > 3) {
    const std::size_t at = cornerToClip(rest);
    const std::size_t count = rest.size();
    if (at == count) return {};
    triangles.push_back(
        {{rest[(at + count - 1) % count].index, rest[at].index, rest[(at + 1) % count].index}});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles.push_back({{rest[0].index, rest[1].index, rest[2].index}});
  return triangles;
}

}  // namespace

float weldTolerance(const std::vector<Eigen::Vector3f>& vertices) {
  float largest = 0.0F;
  for (const Eigen::Vector3f& vertex : vertices)
    largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  return 2.0F * std::numeric_limits<float>::epsilon() * largest;
}

void weldMesh(Mesh& mesh) {
  const std::vector<Eigen::Vector3f> vertices = std::exchange(mesh.vertices_m, {});
  const std::vector<Face> faces = std::exchange(mesh.faces, {});
  std::vector<std::int32_t> used_as(vertices.size(), -1);
  VertexGrid grid(weldTolerance(vertices), vertices.size());
  std::int64_t used = 0;
  const auto weld = [&](std::int32_t old_index) {
    std::int32_t& index = used_as[static_cast<std::size_t>(old_index)];
    if (index >= 0) return index;
    ++used;
    const Eigen::Vector3f& vertex = vertices[static_cast<std::size_t>(old_index)];
    index = grid.find(vertex, mesh.vertices_m);
    if (index >= 0) {
      ++mesh.info.merged_vertices;
      return index;
    }
    index = static_cast<std::int32_t>(mesh.vertices_m.size());
    grid.insert(vertex, index);
    mesh.vertices_m.push_back(vertex);
    return index;
  };
  mesh.faces.reserve(faces.size());
  for (const Face& face : faces) {
    Face corner;
    for (std::size_t i = 0; i < 3; ++i) corner.vertex[i] = weld(face.vertex[i]);
    const auto& v = corner.vertex;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
      ++mesh.info.collapsed_faces;
    else
      mesh.faces.push_back(corner);
  }
  mesh.info.unused_vertices = static_cast<std::int64_t>(vertices.size()) - used;
}

bool triangulatePolygon(const std::vector<Eigen::Vector3f>& vertices,
                        std::span<const std::int32_t> corners, std::vector<Face>& triangles) {
  // Ear clipping takes up to n^3 steps, which only a damaged file makes long.
  constexpr std::size_t kMaxCorners = 1000;
  const bool clips = corners.size() > 3 && corners.size() <= kMaxCorners;
  const std::vector<Face> ears = clips ? earsOf(vertices, corners) : std::vector<Face>();
  if (!ears.empty()) {
    triangles.insert(triangles.end(), ears.begin(), ears.end());
    return true;
  }
  for (std::size_t i = 2; i < corners.size(); ++i)  // a fan
    triangles.push_back({{corners[0], corners[i - 1], corners[i]}});
  return corners.size() == 3;  // the fan of a triangle is the triangle itself
}

}  // namespace boresight::sessions
