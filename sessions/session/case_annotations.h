// SPDX-License-Identifier: Apache-2.0
// The annotations of a session's case, together with those of the cameras that it is linked to.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "sessions/annotation/geometry_meter.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/solve_annotations.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The views that are solved with a case: itself first, then the other cases of its rig that have
/// annotations, in the order of the session.
struct CaseAnnotations {
  std::vector<AnnotatedView> views;  ///< cameras prepared; `name` is the case's id
  bool rigid = false;                ///< several: the pose is the rig's
  bool robust = false;               ///< the session's choice
  double sigmas = 3.0;               ///< number of sigmas that must fit into the requirement
  Requirement requirement;           ///< of the case itself, like the next member
  std::optional<Pose> camera_from_end_effector;

  bool operator==(const CaseAnnotations&) const = default;
};

/// `together` false leaves the other cases of the rig out. A case alone is its own rig
/// (camera_from_rig is the identity). InputError when there is no such case or its camera cannot be
/// used.
CaseAnnotations caseAnnotations(const Session& session, const std::string& case_id,
                                bool together = true);

/// Solution of a case's annotations, with all data shown to the annotator.
struct CaseAnnotationsSolution {
  CaseAnnotations annotations;            ///< the annotations solved
  std::vector<GeometryWarning> warnings;  ///< determined without solving
  AnnotationsResult result;
  std::vector<LeftOut> left_out;  ///< of a solution, by its annotations

  /// The pose of the case itself (of view 0), or empty.
  std::optional<Pose> camera_from_station() const;
  /// Covariance of that pose from the annotations alone: left perturbation, camera frame.
  std::optional<Matrix6d> covariance() const;
  /// The other pose that explains coplanar annotations, or empty.
  std::optional<Pose> ambiguous_camera_from_station() const;
  /// Normalized residuals (in standard deviations) of the outliers among the case's own
  /// annotations, by id; none without a solution.
  std::map<std::string, double> outlierAnnotations() const;
};

/// Solves the result of caseAnnotations(). The desktop program and `whs solve` both use this
/// function, so that they show the same digits. `camera_from_station_guess` is the case's seed, on
/// which the pose of fewer than four points depends: all callers use it, and none the nudged pose,
/// which no input fingerprint covers. `station_m` spans the station (corners of its box), or is
/// empty.
CaseAnnotationsSolution solveCaseAnnotations(CaseAnnotations annotations,
                                             const Pose& camera_from_station_guess,
                                             std::span<const Eigen::Vector3d> station_m);

/// The same with the guess and the box of the station's matched parts taken from the session; the
/// parts are read. InputError also for a part that cannot be read.
CaseAnnotationsSolution solveCaseAnnotations(const Session& session, const std::string& case_id,
                                             bool together = true);

/// The eight corners of a station's box, for solveCaseAnnotations().
std::vector<Eigen::Vector3d> boxCorners(const BoundingBox& box);

}  // namespace boresight::sessions
