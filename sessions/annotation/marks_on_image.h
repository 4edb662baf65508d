// SPDX-License-Identifier: Apache-2.0
// Where a pose puts marks on the image, and least squares over marks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/pnp/normal_equations.h"
#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// Where a pose puts a point of the station in the image, and how that changes with the pose.
struct PredictedPlace {
  bool valid = false;  ///< false where the camera does not project it: the rest says nothing
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double depth_m = 0.0;  ///< z in the camera frame
  /// px per m of the camera frame.
  Eigen::Matrix<double, 2, 3> pixel_by_point = Eigen::Matrix<double, 2, 3>::Zero();
  /// d pixel / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> pixel_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
};
PredictedPlace predictPlace(const Camera& camera, const Pose& camera_from_station,
                            const Eigen::Vector3d& point_in_station_m);

/// Whether a place lies on the image: pixel centres at whole numbers, each pixel one wide.
bool isInImage(const Camera& camera, const Eigen::Vector2d& pixel);

/// A surface hides a point when it is nearer by more than this share of the point's depth: what
/// lies on the surface itself, and the rim of a hole about its centre, is seen.
inline constexpr double kHidingShare = 0.005;

/// Nothing of the mesh is clearly nearer on the same ray. Some milliseconds for a hundred thousand
/// faces.
bool isSeen(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
            const Eigen::Vector3d& point_in_station_m);

/// An edge as the camera bends it: places along it, in order, from start to end; those that do not
/// project are left out. `pieces` >= 1.
std::vector<Eigen::Vector2d> edgeOnImage(const Camera& camera, const Pose& camera_from_station,
                                         const ModelEdge& edge, int pieces = 16);

/// What a mark says about a pose: two residuals (pixels, seen minus predicted) and how they change.
/// Of a point these are x and y; of a line the distances of its two ends from the projected edge,
/// with the whole camera model.
struct MarkResidual {
  bool valid = false;  ///< false where the pose does not project it
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  /// d predicted / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> predicted_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
  /// Of a line at either end: across the edge, unit length, to where a residual is positive.
  Eigen::Vector2d across[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  double depth_m = 0.0;  ///< of the point, or of the edge's middle
};

MarkResidual markResidual(const MarkedView& view, const MarkAddress& at,
                          const Pose& camera_from_station);

/// Normal equations of all `marks` in xi of rig_from_station; `weight` (one per mark, or empty: all
/// 1) multiplies 1 / sigma^2. A mark that does not project counts as missing.
NormalEquations markEquations(std::span<const MarkedView> views, std::span<const MarkAddress> marks,
                              std::span<const double> weight, const Pose& rig_from_station);

/// Least squares over marks from a start: damped Gauss-Newton steps until one is negligible. False
/// when the marks do not determine the pose there; the pose is then left as it was.
[[nodiscard]] bool refineMarks(std::span<const MarkedView> views,
                               std::span<const MarkAddress> marks, std::span<const double> weight,
                               Pose& rig_from_station, NormalEquations& equations);

/// What a pose leaves of a mark, as a vector on the image.
struct MarkVector {
  std::string id;
  Eigen::Vector2d predicted =
      Eigen::Vector2d::Zero();  ///< where the pose puts the point; of a
                                ///< line's end the nearest place of the edge
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
};

/// Of every complete mark that projects, also those that are off; a line has one for each end.
std::vector<MarkVector> markVectors(const MarkedView& view, const Pose& camera_from_station);

}  // namespace boresight::sessions
