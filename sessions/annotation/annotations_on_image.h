// SPDX-License-Identifier: Apache-2.0
// Where a pose puts annotations on the image, and least squares over annotations.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/pnp/normal_equations.h"
#include "sessions/annotation/annotations.h"

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

/// What an annotation says about a pose: two residuals (pixels, seen minus predicted) and how they
/// change. Of a point these are x and y; of a line the distances of its two ends from the projected
/// edge, with the whole camera model.
struct AnnotationResidual {
  bool valid = false;  ///< false where the pose does not project it
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  /// d predicted / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> predicted_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
  /// Of a line at either end: across the edge, unit length, to where a residual is positive.
  Eigen::Vector2d across[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  double depth_m = 0.0;  ///< of the point, or of the edge's middle
};

AnnotationResidual annotationResidual(const AnnotatedView& view, const AnnotationAddress& at,
                                      const Pose& camera_from_station);

/// Normal equations of all `annotations` in xi of rig_from_station; `weight` (one per annotation,
/// or empty: all 1) multiplies 1 / sigma^2. An annotation that does not project counts as missing.
NormalEquations annotationEquations(std::span<const AnnotatedView> views,
                                    std::span<const AnnotationAddress> annotations,
                                    std::span<const double> weight, const Pose& rig_from_station);

/// Least squares over annotations from a start: damped Gauss-Newton steps until one is negligible.
/// False when the annotations do not determine the pose there; the pose is then left as it was.
[[nodiscard]] bool refineAnnotations(std::span<const AnnotatedView> views,
                                     std::span<const AnnotationAddress> annotations,
                                     std::span<const double> weight, Pose& rig_from_station,
                                     NormalEquations& equations);

/// What a pose leaves of an annotation, as a vector on the image.
struct AnnotationVector {
  std::string id;
  Eigen::Vector2d predicted =
      Eigen::Vector2d::Zero();  ///< where the pose puts the point; of a
                                ///< line's end the nearest place of the edge
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
};

/// Of every complete annotation that projects, also those that are off; a line has one for each
/// end.
std::vector<AnnotationVector> annotationVectors(const AnnotatedView& view,
                                                const Pose& camera_from_station);

}  // namespace boresight::sessions
