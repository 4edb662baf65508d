// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

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
/// without covariance and checks where nobody decided. InputError when there is none, a run's trace
/// cannot be read, or the decision states another pose than its run's trace (or the marks).
HandedPose handedPose(const Session& session, const std::string& case_id);

/// The same for several cases (all of them when none is named), in the order of the session; those
/// without a pose are told in `notes`.
struct HandedPoses {
  std::vector<HandedPose> poses;
  std::vector<std::string> notes;
};
HandedPoses handedPoses(const Session& session, const std::vector<std::string>& case_ids);

}  // namespace boresight::sessions
