// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/triangulate.h"

#include <Eigen/Geometry>

namespace boresight::sessions {
namespace {

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
