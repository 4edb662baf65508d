// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/review_subject.h"

#include <algorithm>
#include <utility>

#include "core/localizer/localizer.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/rig_links.h"

namespace boresight::sessions {
namespace {

/// The run of this digest, or the last one.
const RunRecord& runToReview(const Session& session, const std::string& case_id,
                             const std::string& digest) {
  if (const RunRecord* run = findRun(session, case_id, digest)) return *run;
  throw InputError(
      "case " + case_id, "runs",
      digest.empty() ? "it has no run: run it first" : "there is no run with digest " + digest);
}

std::optional<OtherPose> poseOfAnnotations(const Session& session, const LoadedCase& loaded,
                                           std::string& reason) {
  const std::string& id = loaded.source.id;
  reason = "it has no annotations";
  if (!session.annotations.contains(id)) return {};
  const CaseAnnotationsSolution solved =
      solveCaseAnnotations(caseAnnotations(session, id), loaded.source.camera_from_station_seed,
                           boxCorners(matchedBounds(loaded.scene.view())));
  reason = solved.result.reason;
  if (!solved.result.solution) return {};
  OtherPose pose{"the annotation", *solved.camera_from_station(), {*solved.covariance()}};
  pose.degrees_of_freedom = solved.result.solution->degrees_of_freedom;
  return pose;
}

/// Another camera's pose as this camera sees the station. Nothing unless its last run of its own
/// converged with the inputs that it has now.
std::optional<OtherPose> seenByOther(const Session& session, const LoadedCase& loaded,
                                     const SessionCase& other, const RunReader& read_run) {
  const SessionCase& session_case = loaded.source;
  const RunRecord* run = ownRunOf(session, other.id, session_case.id);
  if (run == nullptr || inputsChangedSince(*run, session) ||
      run->status != localizationStatusText(LocalizationStatus::kConverged))
    return {};
  const LocalizationTrace seen = read_run(*run);
  const Pose one_from_other = *linkOfRig(other, session_case);
  const PoseCovariance own =
      poseCovariance(other, loaded.scene.view(), seen.camera_from_station, seen.covariance);
  const auto turned = [turn = adjointOf(one_from_other)](const Matrix6d& covariance) {
    return Matrix6d(turn * covariance * turn.transpose());
  };
  return OtherPose{other.id,
                   one_from_other * seen.camera_from_station,
                   {turned(own.picture), turned(own.mesh_scale), turned(own.calibration)},
                   one_from_other.translation_m};
}

std::vector<OtherPose> otherCameras(const Session& session, const LoadedCase& loaded,
                                    const RunReader& read_run) {
  std::vector<OtherPose> found;
  for (const std::string& id : casesOfRig(session, loaded.source.id)) {
    auto other = seenByOther(session, loaded, *session.findCase(id), read_run);
    if (other) found.push_back(std::move(*other));
  }
  return found;
}

/// InputError when the record cannot be read, or differs from the hash in the session.
std::optional<RecordComparison> againstOnboard(const LoadedCase& loaded,
                                               const LocalizationTrace& run) {
  const auto& known = loaded.source.onboard_record;
  if (!known) return {};
  const std::vector<std::uint8_t> bytes = readFileBytes(known->file, 64 * kMegabyte);
  if (sha256Text(bytes) != known->sha256)
    throw InputError(known->file,
                     "it differs from the session's file: accept it as it is now, or relink it");
  const LocalizationProblem given = loaded.problem();
  return compareRecords(parseRecord(known->file, bytes), recordOf(run, &given),
                        comparisonLimits(loaded));
}

}  // namespace

std::optional<PoseError> truthError(const LoadedCase& loaded, const Pose& camera_from_station) {
  const Pose* truth = judgingTruth(loaded.source);
  if (truth == nullptr) return std::nullopt;
  const PoseComparer comparer(loaded);
  PoseError error = comparer.difference(*truth, camera_from_station);
  error.projection_px = comparer.projection_px(*truth, camera_from_station);
  return error;
}

ReviewSubject runSubject(std::shared_ptr<const LoadedCase> loaded, const Requirement& requirement,
                         LocalizationTrace run) {
  ReviewSubject subject;
  subject.requirement = requirement;
  subject.camera_from_station = run.camera_from_station;
  subject.covariance =
      poseCovariance(loaded->source, loaded->scene.view(), run.camera_from_station, run.covariance);
  subject.run = std::move(run);
  subject.loaded = std::move(loaded);
  return subject;
}

ReviewSubject reviewSubject(const Session& session, std::shared_ptr<const LoadedCase> loaded,
                            PoseSource source, const std::string& digest,
                            const RunReader& read_run) {
  const SessionCase& session_case = loaded->source;
  const Requirement requirement = requirementOf(session, session_case);
  ReviewSubject subject;
  std::string reason;
  auto annotated = poseOfAnnotations(session, *loaded, reason);
  if (source == PoseSource::kRun) {
    subject =
        runSubject(loaded, requirement, read_run(runToReview(session, session_case.id, digest)));
    subject.onboard = againstOnboard(*loaded, *subject.run);
    subject.annotated = std::move(annotated);
  } else {
    if (!annotated)
      throw InputError("case " + session_case.id, "annotations", "they give no pose: " + reason);
    subject.requirement = requirement;
    subject.camera_from_station = annotated->camera_from_station;
    subject.covariance = poseCovariance(session_case, loaded->scene.view(),
                                        subject.camera_from_station, annotated->covariance.picture);
    subject.degrees_of_freedom = annotated->degrees_of_freedom;
    subject.loaded = loaded;
  }
  subject.source = source;
  if (session_case.rig) subject.other_cameras = otherCameras(session, *loaded, read_run);
  return subject;
}

}  // namespace boresight::sessions
