// SPDX-License-Identifier: Apache-2.0
#include "core/search/mirror_image.h"

#include <utility>

namespace boresight {
namespace {

std::uint8_t flipped(std::uint8_t direction) {
  if (direction >= kEdgeDirections) return direction;
  return static_cast<std::uint8_t>((kEdgeDirections - direction) % kEdgeDirections);
}

}  // namespace

void flipLeftRight(DirectedEdges& edges) {
  for (int y = 0; y < edges.height; ++y) {
    std::uint8_t* const row = edges.direction.data() + std::ptrdiff_t{y} * edges.width;
    for (int x = 0; x < edges.width; ++x) row[x] = flipped(row[x]);
    for (int left = 0, right = edges.width - 1; left < right; ++left, --right)
      std::swap(row[left], row[right]);
  }
}

std::array<Pose, 4> mirroredPoses(const Pose& view_from_station, const SurfaceAxes& surface) {
  const Eigen::Vector3d flip(-1.0, 1.0, 1.0);
  const Eigen::Matrix3d turned = flip.asDiagonal() * view_from_station.matrix();
  const Eigen::Vector3d middle_m = flip.cwiseProduct(view_from_station * surface.middle_m);
  std::array<Pose, 4> poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Matrix3d mirror = -Eigen::Matrix3d::Identity();
    if (i < 3) {
      const Eigen::Vector3d axis = surface.axes.col(static_cast<Eigen::Index>(i));
      mirror = Eigen::Matrix3d::Identity() - 2.0 * axis * axis.transpose();
    }
    // Two reflections: a rotation.
    const Eigen::Matrix3d rotation = turned * mirror;
    poses[i].rotation = Eigen::Quaterniond(rotation).normalized();
    poses[i].translation_m = middle_m - rotation * surface.middle_m;
  }
  return poses;
}

}  // namespace boresight
