// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/decision/decision.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/record/compare_records.h"
#include "sessions/session/case_run.h"
#include "sessions/session/pose_comparer.h"
#include "sessions/session/session.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A pose of the same camera from another source.
struct OtherPose {
  std::string from;  ///< for display: "the annotation", "bc-right"
  Pose camera_from_station;
  PoseCovariance covariance = {};  ///< of the annotation only the annotations' own part
  /// Of another camera of the rig: its centre, in this camera's frame.
  Eigen::Vector3d centre_in_camera_m = Eigen::Vector3d::Zero();
  int degrees_of_freedom = 0;  ///< of the annotation's fit
};

/// A pose of a case with all data to check it. A value: it may be checked on any thread.
struct ReviewSubject : JudgedPose {
  std::shared_ptr<const LoadedCase> loaded;
  Requirement requirement;               ///< the case's own, else the preset's
  std::optional<LocalizationTrace> run;  ///< source of the pose; empty for annotated poses
  /// Of the fit of annotations that is the source of the pose; empty for a run.
  std::optional<int> degrees_of_freedom;
  std::optional<OtherPose> annotated;    ///< by the case's annotations, unless these are the source
  std::vector<OtherPose> other_cameras;  ///< as the other cameras of the rig see the station
  std::optional<RecordComparison>
      onboard;  ///< comparison of the case's onboard record, if any, with the run

  /// The case's camera_from_end_effector, if it is known.
  std::optional<Pose> endEffector() const {
    return loaded ? loaded->source.camera_from_end_effector : std::nullopt;
  }
  /// Compares other poses with this one.
  PoseComparer comparer() const { return loaded ? PoseComparer(*loaded) : PoseComparer(); }
  /// A covariance of the pose as it is judged: without turns about axes of symmetry.
  Matrix6d determined(const Matrix6d& of_pose) const {
    return comparer().determined(of_pose, camera_from_station);
  }
};

/// How far a pose is from the truth of its case; empty without a judgingTruth.
std::optional<PoseError> truthError(const LoadedCase& loaded, const Pose& camera_from_station);

/// The pose of a run of this case, without other poses to compare it with.
ReviewSubject runSubject(std::shared_ptr<const LoadedCase> loaded, const Requirement& requirement,
                         LocalizationTrace run);

/// Reads a recorded run: its trace, or a second run of the same inputs.
using RunReader = std::function<LocalizationTrace(const RunRecord&)>;

/// The pose of a case to be checked: that of its last run (or of the run with `digest`), or of its
/// annotations. `read_run` reads the case's run and those of the rig's other cameras. InputError
/// when there is no pose of this source, or something cannot be read.
ReviewSubject reviewSubject(const Session& session, std::shared_ptr<const LoadedCase> loaded,
                            PoseSource source, const std::string& digest = {},
                            const RunReader& read_run = loadSnapshot);

}  // namespace boresight::sessions
