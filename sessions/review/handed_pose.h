// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The pose with which a case is handed over, and what is to be said of it everywhere.
struct HandedPose {
  std::string case_id;
  PoseSource source = PoseSource::kRun;
  Pose camera_from_station;
  PoseCovariance covariance;
  std::string run_digest;  ///< empty: the pose is the marks'
  bool validated = false;
  std::string standing;   ///< standingText: who validated it, or NOT VALIDATED and why
  double score = 1.0;     ///< 1 of a decided or annotated one, else the edge support of its run
  double seconds = -1.0;  ///< that its run took; -1: not known
  std::vector<JudgedCheck> checks;  ///< as they were judged; none without a decision that holds
};

/// The pose of a decision that holds, else that of the last run if it converged, else the marks';
/// without checks and covariance where nobody decided. InputError when there is none, or a run's
/// trace cannot be read.
HandedPose handedPose(const Session& session, const std::string& case_id);

/// The same with checks and covariance: as judged, else as they are now. `loaded` is the case;
/// nullptr: it is read. InputError.
HandedPose checkedPose(const Session& session, const std::string& case_id,
                       std::shared_ptr<const LoadedCase> loaded = nullptr);

/// The trace of the pose's run; nothing when it is the marks', or can no longer be read.
std::optional<LocalizationTrace> traceOf(const Session& session, const HandedPose& pose);

/// The same for several cases (all of them when none is named), in the order of the session; those
/// without a pose are told in `notes`.
struct HandedPoses {
  std::vector<HandedPose> poses;
  std::vector<std::string> notes;
};
HandedPoses handedPoses(const Session& session, const std::vector<std::string>& case_ids);

}  // namespace boresight::sessions
