// SPDX-License-Identifier: Apache-2.0
// validated_pose.json: a pose to hand over, with all data for a later review.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/checks/review_subject.h"
#include "sessions/decision/check.h"
#include "sessions/session/session.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

inline constexpr int kValidatedPoseVersion = 1;

/// The pose that is handed over for a case, and its review status.
struct HandedPose : JudgedPose {
  std::string case_id;
  std::string run_digest;  ///< empty: the pose is from annotations
  bool validated = false;
  std::string review_status;  ///< reviewStatusText: who validated it, or NOT VALIDATED and why
  double score = 1.0;         ///< 1 of a decided or annotated one, else the edge support of its run
  double seconds = -1.0;      ///< that its run took; -1: not known
  std::vector<JudgedCheck> checks;  ///< as they were judged; none without a decision that holds

  bool operator==(const HandedPose&) const = delete;  ///< the base's would compare the pose alone
};

/// The pose of a decision that holds, else that of the last run if it converged, else the
/// annotations'; without covariance and checks without a decision. InputError when there is none,
/// a run's trace cannot be read, or the decision states another pose than its run's trace (or the
/// annotations).
HandedPose handedPose(const Session& session, const std::string& case_id);

struct HandedPoses {
  std::vector<HandedPose> poses;
  std::vector<std::string> notes;  ///< cases without a pose
};
/// The same for several cases (all when none is named), in the order of the session.
/// Calls `progress` before each case of the session, with the number of cases done and of all.
HandedPoses handedPoses(const Session& session, const std::vector<std::string>& case_ids,
                        const std::function<void(int done, int of)>& progress = {});

struct MeasuredPose {
  ReviewSubject subject;      ///< pose, covariance and run
  std::vector<Check> checks;  ///< as checkPose gives them
};

/// Reads the inputs of the pose's case, runs the localization again (or solves the annotations
/// again), repeats the runs of the rig's other cameras that the checks need, and evaluates the
/// checks; the convergence test with `convergence_seeds` seeds, 0: no test. Of `pose` only the
/// case, the source and the run's digest are used, and no trace is read. InputError when something
/// cannot be read or repeated, or a run gives another digest than the session states;
/// `session_file` is for messages.
MeasuredPose measurePose(const Session& session, const HandedPose& pose, int convergence_seeds,
                         const std::filesystem::path& session_file);

/// A pose to hand over, with all measurable data measured again.
struct CheckedPose {
  HandedPose pose;        ///< with its checks: as judged, else current
  Session session;        ///< that was measured: sessionOfCase
  ReviewSubject subject;  ///< as measured
};

/// handedPose(), measured again with all inputs of its decision. InputError, also when the decision
/// or the run's trace differs from the measurement; its sentence names the difference.
CheckedPose checkedPose(const Session& session, const std::string& case_id);

/// The session with this case and those of its rig alone: the run of this digest if any, the runs
/// of the other cameras that the checks need, and the last decision on the case, whose checks are
/// left out unless it holds (they could not be measured). A decision on a run comes with the last
/// run of the case: it holds while that is its run.
Session sessionOfCase(const Session& session, const std::string& case_id,
                      const std::string& run_digest);

/// Difference between the stated and the measured pose, as a sentence; "" when there is none. A
/// run's pose and covariance agree to the last bits; those of annotations, and figures of checks,
/// to 1e-6 of their size.
std::string poseDifference(const HandedPose& stated, const Pose& measured);
std::string covarianceDifference(const HandedPose& stated, const PoseCovariance& measured);
/// Compares state, figure, unit, limit and side of the checks by id, not their wording;
/// `with_convergence` false leaves the checks of the convergence test out.
std::string checksDifference(const HandedPose& stated, const std::vector<Check>& measured,
                             bool with_convergence);
/// Titles of the checks whose title or sentence is another: of another version, or edited. Without
/// `with_convergence` as above.
std::vector<std::string> rewordedChecks(const HandedPose& stated,
                                        const std::vector<Check>& measured, bool with_convergence);
/// InputError unless `difference` is empty.
void requireAsMeasured(const std::string& case_id, const std::string& difference);

/// The file as JSON (README.md lists its members). It holds a session of this one
/// case and its rig, so that the run can be repeated with the inputs; paths are relative
/// to `file`. `run` is the pose's, for its matches; without it they are left out. `state` and
/// `review_status` state when the pose is not validated.
nlohmann::ordered_json validatedPoseJson(const Session& session, const HandedPose& pose,
                                         const std::optional<LocalizationTrace>& run,
                                         const std::filesystem::path& file);

/// Measures the case's pose again (checkedPose), writes it atomically and returns it. InputError
/// when something cannot be measured, or is not as the session states; OutputError.
HandedPose writeValidatedPose(const std::filesystem::path& file, const Session& session,
                              const std::string& case_id);

inline constexpr const char* kChecksumMember = "checksum";
/// Name of the same member in files of version 1.0.
inline constexpr const char* kFormerChecksumMember = "signature";
/// The member `checksum`: SHA-256 over the JSON without it, as compact text. It finds damage, and
/// proves no author: anyone can compute it. `json` must be as parsed: rewriting it may change
/// numbers (1.0 becomes 1).
nlohmann::ordered_json checksumOf(const nlohmann::ordered_json& json,
                                  const std::string& member = kChecksumMember);

/// Result of one check of a validated_pose.json.
struct VerifyFinding {
  bool good = false;
  std::string what;  ///< "checksum", "image", "run", "pose", ...
  std::string text;  ///< one sentence
};

struct VerifyReport {
  std::string
      review_status;  ///< who validated the pose, or NOT VALIDATED and why, as stated in the file
  std::vector<VerifyFinding> findings;
  /// Statements that were not or cannot be verified: who decided, when, why a failed check was
  /// waived, and a decision that is stated to hold no longer. One sentence each.
  std::vector<std::string> not_proved;

  bool validated = false;  ///< stated: by a person, and by a second one where that is required

  /// Whether all measurements are as stated; the pose may still be NOT VALIDATED.
  bool good() const;
};

/// Locations of the files that a validated_pose.json names.
struct VerifyPlaces {
  std::optional<std::filesystem::path> folder = std::nullopt;
  std::optional<std::filesystem::path> signers = std::nullopt;
};
/// Checks a validated_pose.json: its checksum, the files that it names by their hashes, whether the
/// decision in it holds (or is stated not to), and whether all members follow from each other. With
/// `run_again` the run is repeated (the annotations are solved again), and its digest, pose,
/// covariance, matches and every check are compared with the file; with `convergence_again` also
/// the convergence test. Missing files are searched below `places.folder` by their hashes; with
/// `places.signers` the deciders must have signed the file with their keys (key_signature.h).
/// InputError when the file is not a validated_pose.json.
VerifyReport verifyPose(const std::filesystem::path& file, bool run_again,
                        bool convergence_again = false, const VerifyPlaces& places = {});

}  // namespace boresight::sessions
