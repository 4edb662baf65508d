// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/wire_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace boresight::peers {
namespace {

constexpr double kLooksAway = -0.34;  // cosine of 90 + 20 deg

struct SeenFace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, or zero
  double facing = 0.0;  ///< cosine between normal and direction to the camera
};

SeenFace seenFace(const sessions::SceneMesh& scene, const Face& face,
                  const Eigen::Vector3d& camera_in_station_m) {
  std::array<Eigen::Vector3d, 3> corner;
  for (std::size_t i = 0; i < 3; ++i)
    corner[i] =
        scene.vertices_in_station_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
  SeenFace seen;
  const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  if (normal.norm() < 1e-14) return seen;
  seen.normal = normal.normalized();
  seen.facing = seen.normal.dot((camera_in_station_m - corner[0]).normalized());
  return seen;
}

using Edge = std::pair<int, int>;

bool isLine(const std::vector<int>& faces, const std::vector<SeenFace>& seen,
            double crease_cosine) {
  if (faces.size() != 2) return true;
  const SeenFace& one = seen[static_cast<std::size_t>(faces[0])];
  const SeenFace& other = seen[static_cast<std::size_t>(faces[1])];
  if (one.normal.isZero() || other.normal.isZero()) return false;
  return one.normal.dot(other.normal) < crease_cosine || (one.facing > 0.0) != (other.facing > 0.0);
}

}  // namespace

WireModel wireModel(const sessions::SceneMesh& scene, const Pose& camera_from_station,
                    double crease_deg) {
  WireModel model;
  for (const Eigen::Vector3f& vertex : scene.vertices_in_station_m)
    model.points_m.push_back(vertex.cast<double>());
  const Eigen::Vector3d camera_in_station_m = camera_from_station.inverse().translation_m;
  std::vector<SeenFace> seen;
  std::map<Edge, std::vector<int>> faces_of;
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    const auto& vertex = scene.faces[i].vertex;
    seen.push_back(seenFace(scene, scene.faces[i], camera_in_station_m));
    if (seen.back().facing > kLooksAway) model.faces.push_back({vertex[0], vertex[1], vertex[2]});
    if (!scene.parts[scene.part_of_face[i]].match) continue;
    for (std::size_t k = 0; k < 3; ++k)
      faces_of[std::minmax(vertex[k], vertex[(k + 1) % 3])].push_back(static_cast<int>(i));
  }
  const double crease_cosine = std::cos(crease_deg * std::numbers::pi / 180.0);
  for (const auto& [edge, faces] : faces_of) {
    const bool in_view = std::any_of(faces.begin(), faces.end(), [&](int face) {
      return seen[static_cast<std::size_t>(face)].facing > kLooksAway;
    });
    if (in_view && isLine(faces, seen, crease_cosine))
      model.lines.push_back({edge.first, edge.second});
  }
  return model;
}

}  // namespace boresight::peers
