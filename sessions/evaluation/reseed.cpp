// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/reseed.h"

#include "core/base/math.h"
#include "core/base/random.h"

namespace boresight::sessions {
namespace {

/// FNV-1a, 64 bits: standard hashes differ between libraries.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char character : text) {
    hash ^= static_cast<std::uint8_t>(character);
    hash *= 0x100000001b3u;
  }
  return hash;
}

/// Uniform in the unit ball; a point of the cube is inside with probability 0.52, so that the
/// bound is never met.
Eigen::Vector3d inUnitBall(Random& random) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    Eigen::Vector3d point;
    for (int i = 0; i < 3; ++i) point[i] = random.uniform(-1.0, 1.0);
    if (point.squaredNorm() <= 1.0) return point;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

Vector6d drawOffset(const DeclaredUncertainty& uncertainty, double scale,
                    const std::string& case_id, int number) {
  Random random(hashOf(case_id), static_cast<std::uint64_t>(number));
  const Eigen::Vector3d rotation = inUnitBall(random);
  const Eigen::Vector3d translation = inUnitBall(random);
  Vector6d offset;
  offset << scale * kDegree_rad * rotation.cwiseProduct(uncertainty.rotation_deg),
      scale * translation.cwiseProduct(uncertainty.translation_m);
  return offset;
}

Pose seedForOffset(const Pose& camera_from_station_true, const Vector6d& offset,
                   UncertaintyPivot pivot, const Eigen::Vector3d& matched_centre_in_station_m) {
  const Eigen::Vector3d translation_m = offset.tail<3>();
  // The station's centre turns about itself, so that the truth sees it at c + t.
  const Eigen::Vector3d pivot_in_camera_m =
      pivot == UncertaintyPivot::kStation
          ? Eigen::Vector3d(camera_from_station_true * matched_centre_in_station_m - translation_m)
          : Eigen::Vector3d::Zero();
  const Eigen::Quaterniond back = rotationExp(-offset.head<3>());
  Pose seed;
  seed.rotation = (back * camera_from_station_true.rotation).normalized();
  seed.translation_m = back * Eigen::Vector3d(camera_from_station_true.translation_m -
                                              pivot_in_camera_m - translation_m) +
                       pivot_in_camera_m;
  return seed;
}

}  // namespace boresight::sessions
