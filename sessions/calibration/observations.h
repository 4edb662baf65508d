// SPDX-License-Identifier: Apache-2.0
// Observations of station points in images: from annotations or from runs.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/pose.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct PointObservation {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  /// Only the distance along this normal counts; zero: both coordinates count.
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

/// The observations of an image.
struct CalibrationView {
  std::string case_id;
  Pose camera_from_station;  ///< start of the adjustment
  std::vector<PointObservation> points;
};

/// Source of a case's observations.
enum class ObservationSource { kAnnotations, kRuns };

/// Fewest observations of a view.
inline constexpr std::size_t kFewestPoints = 6;
/// One view for each case with at least `kFewestPoints` observations: enabled point annotations, or
/// edge places of the last refinement of the last converged run. InputError when a run cannot be
/// read, or has other inputs than its case has now.
std::vector<CalibrationView> observationsOf(const Session& session, ObservationSource source);

}  // namespace boresight::sessions
