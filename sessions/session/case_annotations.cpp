// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_annotations.h"

#include <utility>

#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/input_check.h"
#include "sessions/session/rig_links.h"

namespace boresight::sessions {
namespace {

AnnotatedView viewOf(const Session& session, const SessionCase& session_case,
                     const Pose& camera_from_rig) {
  AnnotatedView view;
  view.name = session_case.id;
  view.camera = session_case.camera;
  if (prepareCamera(view.camera) != Status::kOk)
    throw InputError("case " + session_case.id, "camera",
                     "its parameters are not those of a camera");
  view.camera_from_rig = camera_from_rig;
  if (const auto found = session.annotations.find(session_case.id);
      found != session.annotations.end())
    view.annotations = *found->second;
  return view;
}

}  // namespace

CaseAnnotations caseAnnotations(const Session& session, const std::string& case_id, bool together) {
  const SessionCase& chosen = knownCase(session, case_id);
  CaseAnnotations annotations;
  annotations.robust = session.robust_annotations;
  annotations.sigmas = checkLimits(session.review.preset, session.review.limits).sigmas;
  annotations.requirement = requirementOf(session, chosen);
  annotations.camera_from_end_effector = chosen.camera_from_end_effector;
  annotations.views.push_back(viewOf(session, chosen, Pose()));
  if (!together) return annotations;
  for (const std::string& id : casesOfRig(session, case_id)) {
    if (!session.annotations.contains(id)) continue;
    const SessionCase& other = *session.findCase(id);
    annotations.views.push_back(viewOf(session, other, other.rig->camera_from_rig));
  }
  annotations.rigid = annotations.views.size() > 1;
  if (annotations.rigid) annotations.views[0].camera_from_rig = chosen.rig->camera_from_rig;
  return annotations;
}

std::optional<Pose> CaseAnnotationsSolution::camera_from_station() const {
  if (!result.solution) return {};
  return result.solution->camera_from_station[0];
}

std::optional<Matrix6d> CaseAnnotationsSolution::covariance() const {
  if (!result.solution) return {};
  return cameraCovariance(*result.solution, annotations.views[0]);
}

std::optional<Pose> CaseAnnotationsSolution::ambiguous_camera_from_station() const {
  if (!result.solution || !result.solution->ambiguous) return {};
  return annotations.views[0].camera_from_rig * result.solution->ambiguous->rig_from_station;
}

std::map<std::string, double> CaseAnnotationsSolution::outlierAnnotations() const {
  std::map<std::string, double> found;
  if (!result.solution) return found;
  for (const SolvedAnnotation& annotation : result.solution->annotations)
    if (annotation.address.view == 0 && annotation.isOutlier())
      found[annotationId(annotations.views, annotation.address)] = annotation.normalized;
  return found;
}

CaseAnnotationsSolution solveCaseAnnotations(CaseAnnotations annotations,
                                             const Pose& camera_from_station_guess,
                                             std::span<const Eigen::Vector3d> station_m) {
  CaseAnnotationsSolution solved;
  solved.annotations = std::move(annotations);
  const std::vector<AnnotatedView>& views = solved.annotations.views;
  SolveAnnotationsOptions options;
  options.robust = solved.annotations.robust;
  options.rig_from_station_guess = views[0].camera_from_rig.inverse() * camera_from_station_guess;
  solved.warnings = geometryWarnings(views, &*options.rig_from_station_guess, station_m);
  solved.result = solveAnnotations(views, options);
  if (solved.result.solution) solved.left_out = leaveOneOut(views, *solved.result.solution);
  const double sigmas = solved.annotations.sigmas;
  const std::string excess =
      sigmaExcessText(sigmas * sigmas * solved.covariance().value_or(Matrix6d::Zero()),
                      solved.annotations.camera_from_end_effector, solved.annotations.requirement);
  if (!excess.empty()) solved.warnings.push_back(imprecisionWarning(sigmas, excess));
  return solved;
}

CaseAnnotationsSolution solveCaseAnnotations(const Session& session, const std::string& case_id,
                                             bool together) {
  CaseAnnotations annotations = caseAnnotations(session, case_id, together);
  const SessionCase& session_case = *session.findCase(case_id);
  const SceneMesh scene = readKnownScene(session_case);
  return solveCaseAnnotations(std::move(annotations), session_case.camera_from_station_seed,
                              boxCorners(matchedBounds(scene.view())));
}

std::vector<Eigen::Vector3d> boxCorners(const BoundingBox& box) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(box.corner(i));
  return corners;
}

}  // namespace boresight::sessions
