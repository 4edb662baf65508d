// SPDX-License-Identifier: Apache-2.0
// A pose measured again from its inputs, to be compared with what is stated of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/review/handed_pose.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/check.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct MeasuredPose {
  ReviewSubject subject;      ///< pose, covariance and run
  std::vector<Check> checks;  ///< as checkPose gives them
};

/// Reads the inputs of the pose's case, runs the localization again (or solves the marks again),
/// repeats the runs of the rig's other cameras that the checks ask, and makes the checks; the
/// convergence test with `basin_seeds` seeds, 0: without. Of `pose` only the case, the source and
/// the run's digest are used, and no trace is read. InputError when something cannot be read or
/// repeated, or a run gives another digest than the session states; `session_file` is for messages.
MeasuredPose measurePose(const Session& session, const HandedPose& pose, int basin_seeds,
                         const std::filesystem::path& session_file);

/// A pose to hand over, of which everything that can be measured was measured.
struct CheckedPose {
  HandedPose pose;        ///< with its checks: as they were judged, else as they are now
  Session session;        ///< that was measured: sessionOfCase
  ReviewSubject subject;  ///< as measured
};

/// handedPose, measured again with all that its decision rests on. InputError, also when the
/// decision or the run's trace states something else than is measured: a sentence says what.
CheckedPose checkedPose(const Session& session, const std::string& case_id);

/// The session with this case and those of its rig alone: the run of this digest if any, the runs
/// of the other cameras that the checks ask, and the last decision on the case, whose checks are
/// left out unless it holds (they could not be measured).
Session sessionOfCase(const Session& session, const std::string& case_id,
                      const std::string& run_digest);

/// What of a stated pose is not as measured, as a sentence; "" when nothing. A run's pose and
/// covariance agree to the last bits; those of marks, and figures of checks, to 1e-6 of their size.
std::string poseDifference(const HandedPose& stated, const Pose& measured);
std::string covarianceDifference(const HandedPose& stated, const PoseCovariance& measured);
/// `with_basin` false leaves the checks of the convergence test out.
std::string checksDifference(const HandedPose& stated, const std::vector<Check>& measured,
                             bool with_basin);
/// InputError unless `difference` is empty.
void requireAsMeasured(const std::string& case_id, const std::string& difference);

}  // namespace boresight::sessions
