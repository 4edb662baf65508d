// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as the lines that trackers of edges follow.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/pose.h"
#include "sessions/io/scene_mesh.h"

namespace boresight::peers {

/// Lines to follow, and faces that hide what lies behind them.
struct WireModel {
  std::vector<Eigen::Vector3d> points_m;  ///< station frame
  std::vector<std::array<int, 2>> lines;
  std::vector<std::array<int, 3>> faces;
};

/// Lines of the matched parts: borders, creases sharper than `crease_deg`, and, as seen from
/// `camera_from_station`, those between a face that looks at the camera and one that does not (the
/// outline of what is round). Faces: all that do not look away by more than 20 deg.
WireModel wireModel(const sessions::SceneMesh& scene, const Pose& camera_from_station,
                    double crease_deg);

}  // namespace boresight::peers
