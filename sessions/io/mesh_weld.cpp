// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

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

}  // namespace boresight::sessions
