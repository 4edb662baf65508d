// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <unsupported/Eigen/BVH>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/datasets/symmetries.h"

namespace boresight::sessions {

/// Model of a station for pose errors: vertices in the station frame, metres, and symmetries.
struct ModelView {
  std::span<const Eigen::Vector3f> vertices_in_station_m;
  const Symmetries* symmetries = nullptr;  ///< nullptr: no symmetries
};

/// The errors of the BOP challenges (Hodan 2020 for MSSD and MSPD; Hinterstoisser 2012 for ADD and
/// ADI). Each is the minimum over the symmetric poses; turns about an axis are sampled every 2 pi /
/// 315, as the challenge does, and then refined.
///
/// MSSD, m: the largest distance between a vertex under the estimate and under the truth.
double surfaceDistance_m(const Pose& camera_from_station_true,
                         const Pose& camera_from_station_estimated, const ModelView& model);
/// MSPD, px: the same between their projections. Vertices that the camera cannot project under the
/// truth do not count; one that only the estimate hides counts as an image diagonal. Empty when
/// none can be projected.
std::optional<double> projectionDistance_px(const Camera& camera,
                                            const Pose& camera_from_station_true,
                                            const Pose& camera_from_station_estimated,
                                            const ModelView& model);
/// ADD, m: the mean distance between a vertex under the estimate and under the truth.
double meanDistance_m(const Pose& camera_from_station_true,
                      const Pose& camera_from_station_estimated, const ModelView& model);
/// ADI, m: the mean distance from a vertex under the truth to the nearest under the estimate.
/// Insensitive to symmetries by itself.
double meanNearestDistance_m(const Pose& camera_from_station_true,
                             const Pose& camera_from_station_estimated, const ModelView& model);

/// The pose that shows the station as `camera_from_station` does and is nearest to another: the
/// equivalent with the smallest surface distance. The pose itself where it equals the other one, or
/// there are no symmetries.
Pose nearestEquivalent(const Pose& camera_from_station, const Pose& other_camera_from_station,
                       const ModelView& model);

/// Small motions of a pose, a column each: left perturbations in the camera frame.
using PoseMotions = Eigen::Matrix<double, 6, Eigen::Dynamic>;
/// Those that do not change the appearance of the station: turns about its axes of symmetry.
PoseMotions symmetricMotions(const Pose& camera_from_station, const Symmetries& symmetries);
/// Takes the part along `motions` out of a perturbation; the rest is orthogonal to them in the
/// metric, which is positive semidefinite.
Matrix6d projectionWithout(const PoseMotions& motions, const Matrix6d& metric);
/// A pose's covariance without turns about axes of symmetry, which no comparison of poses contains:
/// of the motion that moves the vertices least for each turn. Unchanged without such axes.
Matrix6d determinedCovariance(const Matrix6d& covariance, const Pose& camera_from_station,
                              const ModelView& model);

/// The judged errors of an estimate: poseError and projectionError against the true pose's
/// symmetric equivalent with the smallest surface distance.
PoseError errorToTruth(const Camera& camera, const Pose& camera_from_station_true,
                       const Pose& camera_from_station_estimated,
                       const std::optional<Pose>& camera_from_end_effector, const ModelView& model);

/// All reported errors of an estimate: errorToTruth and the four above.
PoseError wholeError(const Camera& camera, const Pose& camera_from_station_true,
                     const Pose& camera_from_station_estimated,
                     const std::optional<Pose>& camera_from_end_effector, const ModelView& model);

/// Finds the nearest of many points. Any unit.
class NearestPoint {
 public:
  explicit NearestPoint(const std::vector<Eigen::Vector3d>& points);

  /// From `point` to the nearest; infinity when there are none.
  double distance(const Eigen::Vector3d& point) const;

 private:
  Eigen::KdBVH<double, 3, Eigen::Vector3d> tree_;
  bool empty_ = true;
};

}  // namespace boresight::sessions
