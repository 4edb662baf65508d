// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "sessions/checks/review_subject.h"

namespace boresight::sessions {

/// Scale of the mesh that the cameras of a rig agree on, relative to the given mesh.
struct MeshScale {
  double change = 0.0;  ///< 0.01: the object is 1 % smaller than its mesh
  double sigma = 0.0;
};

/// With a mesh too large by a factor s each camera sees the station s times as far from its own
/// centre; so the positions of a point by two cameras differ by (s - 1) times the baseline
/// between them. Weighted least squares over the other cameras, with the covariances of images and
/// calibrations. Empty without another camera or without a baseline.
std::optional<MeshScale> meshScaleByRig(const ReviewSubject& subject,
                                        const Eigen::Vector3d& point_in_station_m);

}  // namespace boresight::sessions
