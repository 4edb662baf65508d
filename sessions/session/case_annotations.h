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
  std::vector<std::string> case_ids;  ///< by view
  std::vector<AnnotatedView> views;   ///< cameras prepared; `name` is the case's id
  bool rigid = false;                 ///< several: the pose is the rig's
  Requirement requirement;            ///< of the case itself, as is the next
  std::optional<Pose> camera_from_end_effector;
};

/// `together` false leaves the other cases of the rig out. A case alone is its own rig
/// (camera_from_rig is the identity). InputError when there is no such case or its camera cannot be
/// used.
CaseAnnotations caseAnnotations(const Session& session, const std::string& case_id,
                                bool together = true);

/// Everything that an annotator is told of a case's annotations.
struct CaseAnnotationsSolution {
  CaseAnnotations annotations;            ///< what was solved
  std::vector<GeometryWarning> warnings;  ///< said before and without solving
  AnnotationsResult result;
  std::vector<LeftOut> left_out;  ///< of a solution, by its annotations

  /// The pose of the case itself (of view 0), or nothing.
  std::optional<Pose> camera_from_station() const;
  /// Its covariance as the annotations alone say: left perturbation, camera frame.
  std::optional<Matrix6d> covariance() const;
  /// What of its one sigma exceeds the requirement: `sigmaExcessText`; "" when nothing does.
  std::string sigmaExcess() const;
  /// The other one that explains coplanar annotations, or nothing.
  std::optional<Pose> ambiguous_camera_from_station() const;
  /// Normalized residuals (in standard deviations) of those annotations of the case itself that
  /// stand out, by id; none without a solution.
  std::map<std::string, double> outlierAnnotations() const;
};

/// Solves what `caseAnnotations` gives: the one function behind the desktop program and `whs
/// solve`, so that both show the same digits. `camera_from_station_guess` is the case's seed or
/// working pose; `station_m` spans the station (corners of its box), or is empty.
CaseAnnotationsSolution solveCaseAnnotations(CaseAnnotations annotations,
                                             const Pose& camera_from_station_guess,
                                             std::span<const Eigen::Vector3d> station_m,
                                             bool robust);

/// The same with what the session says of the case: the guess, and the box of the station's matched
/// parts, which are read. InputError also for a part that cannot be read.
CaseAnnotationsSolution solveCaseAnnotations(const Session& session, const std::string& case_id,
                                             bool together, bool robust);

/// Where solving a case's annotations begins: its working pose, else its seed. The last bits of a
/// solution depend on it, so everybody begins here.
const Pose& annotationsGuess(const SessionCase& session_case);

/// The eight corners of a station's box, as `solveCaseAnnotations` asks for them.
std::vector<Eigen::Vector3d> boxCorners(const BoundingBox& box);

}  // namespace boresight::sessions
