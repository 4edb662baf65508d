// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "core/base/math.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/io/datasets/dataset_file.h"

namespace boresight::sessions {

/// How far an estimate is from the truth.
struct PoseError {
  double normal_mm = 0.0;      ///< along the true camera's axis, signed
  double lateral_mm = 0.0;     ///< across it
  double rotation_mrad = 0.0;  ///< between the axes (out of plane)
  double in_plane_mrad = 0.0;  ///< twist about the axis, signed, in (-pi, pi] rad; not judged
  double geodesic_mrad = 0.0;  ///< whole rotation angle; not judged
  std::optional<double> projection_px;  ///< empty when not requested or not available
  /// The errors of the BOP challenges (model_error.h); empty when not requested.
  std::optional<double> mssd_mm = {};
  std::optional<double> mspd_px = {};
  std::optional<double> add_mm = {};
  std::optional<double> adi_mm = {};
};

/// With E = camera_true_from_camera_estimated = [R|t] and p the end effector's origin in the camera
/// frame (0 without one): d = R p + t - p; normal = d_z, lateral = hypot(d_x, d_y), rotation =
/// angle(z, R z), in_plane = twist of R about z, geodesic = angle of R. The projection stays empty.
PoseError poseError(const Pose& camera_from_station_true, const Pose& camera_from_station_estimated,
                    const std::optional<Pose>& camera_from_end_effector);

/// How a point of the camera frame moves with a small perturbation: d = r x p + t.
Eigen::Matrix<double, 3, 6> displacementOf(const Eigen::Vector3d& point_in_camera_m);

/// Mean over the vertices of the distance between their projections under estimate and truth, px.
/// Vertices that the camera cannot project under the truth do not count; one that only the estimate
/// puts behind the camera or outside its field counts as a whole image diagonal. Empty when no
/// vertex can be projected under the truth.
std::optional<double> projectionError(const Camera& camera, const Pose& camera_from_station_true,
                                      const Pose& camera_from_station_estimated,
                                      std::span<const Eigen::Vector3f> vertices_in_station_m);

inline constexpr double kMradPerDegree = 1e3 * kDegree_rad;

/// A figure that a requirement may limit, with the corresponding error, in the requirement's unit.
struct JudgedFigure {
  std::optional<double> Requirement::*limit;
  std::optional<double> (*error)(const PoseError&);
};
/// Normal, lateral, rotation, projection.
extern const std::array<JudgedFigure, 4> kJudgedFigures;
/// The requirement's rotation limit in the unit of PoseError.
std::optional<double> rotationLimit_mrad(const Requirement& requirement);

/// Whether the error is within `factor` times all limits of the requirement. An unknown projection
/// error does not meet a limit on it.
bool meetsRequirement(const PoseError& error, const Requirement& requirement, double factor = 1.0);

/// Whether the error exceeds 3 times the requirement: a completed run is then a gross false
/// positive.
bool isGross(const PoseError& error, const Requirement& requirement);

/// Over completed runs.
struct Statistics {
  std::int64_t count = 0;
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation of the population
  double maximum = 0.0;    ///< of the absolute values
};
Statistics statistics(std::span<const double> values);

/// One sigma of a pose in the terms that requirements judge (compare PoseError).
struct PoseSigma {
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();  ///< along the camera's axes
  Eigen::Vector3d rotation_mrad = Eigen::Vector3d::Zero();   ///< about the camera's axes
  double normal_mm = 0.0;                                    ///< along the camera's axis
  double lateral_mm = 0.0;         ///< across it: root of the sum of both variances
  double out_of_plane_mrad = 0.0;  ///< between the axes: root of the sum of both variances
};

/// Where translations are judged: "end effector", or "camera" where that is not known.
const char* judgedPlace(const std::optional<Pose>& camera_from_end_effector);

/// From a covariance over xi = (rotation rad, translation m) of the left perturbation in the camera
/// frame. Translations are those of the end effector's origin p in the camera frame (the camera's
/// centre without one): d = r x p + t. Empty when the covariance is zero, not finite, or has a
/// negative variance.
std::optional<PoseSigma> poseSigma(const Matrix6d& covariance,
                                   const std::optional<Pose>& camera_from_end_effector);

/// One sigma of projected points: root of the mean over the points of the variance of both
/// coordinates together, px. Empty when none of them projects.
std::optional<double> projectionSigma(const Camera& camera, const Pose& camera_from_station,
                                      std::span<const Eigen::Vector3f> points_in_station_m,
                                      const Matrix6d& covariance);

/// Largest ratio of the error to a limit of the requirement; above 1: exceeded.
double requirementShare(const PoseError& error, const Requirement& requirement);

/// The one-sigma figure of a pose that exceeds the requirement most, as a clause: "10.4 mm across
/// the view axis at the end effector, 26 times the 0.4 mm required". "" when none does, or the
/// covariance is zero. A requirement in pixels is not evaluated.
std::string sigmaExcessText(const Matrix6d& covariance,
                            const std::optional<Pose>& camera_from_end_effector,
                            const Requirement& requirement);

}  // namespace boresight::sessions
