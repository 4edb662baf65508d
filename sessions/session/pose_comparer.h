// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/evaluation/model_error.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/record/compare_records.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

/// Compares poses of a case's station. Poses that differ by a declared symmetry count as the same:
/// each comparison is to the equivalent that is nearest.
class PoseComparer {
 public:
  /// Of a station without symmetries; translations are compared at the camera.
  PoseComparer() = default;
  explicit PoseComparer(const LoadedCase& loaded);
  /// `mesh` is the case's scene; without symmetries only projection_px() reads it.
  PoseComparer(const SessionCase& session_case, const MeshView& mesh);

  /// Whether equivalents are declared.
  bool symmetric() const { return !symmetries_.empty(); }
  /// The equivalent of a pose that is nearest to another.
  Pose equivalent(const Pose& camera_from_station, const Pose& nearest_to) const;
  /// poseError of an estimate against the nearest equivalent of a reference. No projection.
  PoseError difference(const Pose& camera_from_station_reference,
                       const Pose& camera_from_station_estimated) const;
  /// projectionError of the same. Empty without a case.
  std::optional<double> projection_px(const Pose& camera_from_station_reference,
                                      const Pose& camera_from_station_estimated) const;
  /// A covariance of a pose, or of a difference from it, without turns about axes of symmetry.
  Matrix6d determined(const Matrix6d& covariance, const Pose& camera_from_station) const;
  /// Where translations are compared; empty: at the camera.
  const std::optional<Pose>& endEffector() const { return camera_from_end_effector_; }
  /// projectionSigma of a pose.
  std::optional<double> projectionSigma_px(const Pose& camera_from_station,
                                           const Matrix6d& covariance) const;

 private:
  ModelView model() const { return {vertices_, &symmetries_}; }

  std::optional<Camera> camera_;
  std::optional<Pose> camera_from_end_effector_;
  Symmetries symmetries_;
  std::vector<Eigen::Vector3f> vertices_;  ///< of matched parts, station frame, m
};

/// A comparer without projections: of a station without symmetries it does not read the mesh.
PoseComparer differenceComparer(const LoadedCase& loaded);

/// Limits of a comparison of two runs of a case, with its symmetries.
ComparisonLimits comparisonLimits(const LoadedCase& loaded);

}  // namespace boresight::sessions
