// SPDX-License-Identifier: Apache-2.0
// Projection of annotations into the image, and least squares over annotations.
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

/// Projection of a station point under a pose, with its derivatives.
struct PredictedPlace {
  bool valid = false;  ///< false: not projected; the other members are unset
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double depth_m = 0.0;  ///< z in the camera frame
  /// px per m of the camera frame.
  Eigen::Matrix<double, 2, 3> pixel_by_point = Eigen::Matrix<double, 2, 3>::Zero();
  /// d pixel / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> pixel_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
};
PredictedPlace predictPlace(const Camera& camera, const Pose& camera_from_station,
                            const Eigen::Vector3d& point_in_station_m);

/// Whether a position lies in the image; pixel centres have integer coordinates.
bool isInImage(const Camera& camera, const Eigen::Vector2d& pixel);

/// A surface hides a point when it is nearer by more than this share of the point's depth: points
/// on the surface itself, and the centre of a hole behind its rim, count as visible.
inline constexpr double kHidingShare = 0.005;

/// Whether the point projects and no face hides it (kHidingShare). Takes some milliseconds for
/// 100,000 faces.
bool isSeen(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
            const Eigen::Vector3d& point_in_station_m);

/// Projection of an edge, including distortion: image positions in order from start to end; points
/// that do not project are left out. `pieces` >= 1.
std::vector<Eigen::Vector2d> edgeOnImage(const Camera& camera, const Pose& camera_from_station,
                                         const ModelEdge& edge, int pieces = 16);

/// Two residuals of an annotation (px, observed minus predicted) and their derivatives. For a point
/// these are x and y; for a line, the distances of its two ends from the projected edge, with the
/// full camera model.
struct AnnotationResidual {
  bool valid = false;  ///< false where the pose does not project it
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  /// d predicted / d xi, xi = (rotation rad, translation m), left perturbation, camera frame.
  Eigen::Matrix<double, 2, 6> predicted_by_xi = Eigen::Matrix<double, 2, 6>::Zero();
  /// For each end of a line: unit vector across the edge, in the direction of positive residuals.
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

/// Residual of an annotation as a vector in the image.
struct AnnotationVector {
  std::string id;
  Eigen::Vector2d predicted =
      Eigen::Vector2d::Zero();  ///< projection of the point; for a line's end, the nearest point of
                                ///< the projected edge
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
};

/// One vector for each complete annotation that projects, including disabled ones; for a line, one
/// for each end.
std::vector<AnnotationVector> annotationVectors(const AnnotatedView& view,
                                                const Pose& camera_from_station);

}  // namespace boresight::sessions
