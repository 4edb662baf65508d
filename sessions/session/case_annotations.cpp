// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_annotations.h"

#include <utility>

#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/input_check.h"

namespace boresight::sessions {
namespace {

Annotations annotationsOf(const Session& session, const std::string& case_id) {
  const auto found = session.annotations.find(case_id);
  return found == session.annotations.end() ? Annotations() : *found->second;
}

AnnotatedView viewOf(const Session& session, const SessionCase& session_case,
                     const Pose& camera_from_rig) {
  AnnotatedView view;
  view.name = session_case.id;
  view.camera = session_case.camera;
  if (prepareCamera(view.camera) != Status::kOk)
    throw InputError("case " + session_case.id, "camera",
                     "its parameters are not those of a camera");
  view.camera_from_rig = camera_from_rig;
  view.annotations = annotationsOf(session, session_case.id);
  return view;
}

}  // namespace

CaseAnnotations caseAnnotations(const Session& session, const std::string& case_id, bool together) {
  const SessionCase* chosen = &knownCase(session, case_id);
  CaseAnnotations case_annotations;
  case_annotations.robust = session.robust_annotations;
  case_annotations.sigmas = checkLimits(session.review.preset, session.review.limits).sigmas;
  case_annotations.requirement = requirementOf(session, *chosen);
  case_annotations.camera_from_end_effector = chosen->camera_from_end_effector;
  const auto add = [&](const SessionCase& session_case, const Pose& camera_from_rig) {
    case_annotations.case_ids.push_back(session_case.id);
    case_annotations.views.push_back(viewOf(session, session_case, camera_from_rig));
  };
  add(*chosen, Pose());
  if (!together || !chosen->rig) return case_annotations;
  for (const auto& other : session.cases) {
    if (other->id == case_id || !other->rig || other->rig->id != chosen->rig->id) continue;
    if (session.annotations.contains(other->id)) add(*other, other->rig->camera_from_rig);
  }
  case_annotations.rigid = case_annotations.views.size() > 1;
  if (case_annotations.rigid)
    case_annotations.views[0].camera_from_rig = chosen->rig->camera_from_rig;
  return case_annotations;
}

std::optional<Pose> CaseAnnotationsSolution::camera_from_station() const {
  if (!result.solution) return {};
  return result.solution->camera_from_station[0];
}

std::optional<Matrix6d> CaseAnnotationsSolution::covariance() const {
  if (!result.solution) return {};
  return cameraCovariance(*result.solution, annotations.views[0]);
}

std::string CaseAnnotationsSolution::sigmaExcess() const {
  const double sigmas = annotations.sigmas;
  return sigmaExcessText(sigmas * sigmas * covariance().value_or(Matrix6d::Zero()),
                         annotations.camera_from_end_effector, annotations.requirement);
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
  CaseAnnotationsSolution case_annotations_solution;
  case_annotations_solution.annotations = std::move(annotations);
  const std::vector<AnnotatedView>& views = case_annotations_solution.annotations.views;
  SolveAnnotationsOptions options;
  options.robust = case_annotations_solution.annotations.robust;
  options.rig_from_station_guess = views[0].camera_from_rig.inverse() * camera_from_station_guess;
  case_annotations_solution.warnings =
      geometryWarnings(views, &*options.rig_from_station_guess, station_m);
  case_annotations_solution.result = solveAnnotations(views, options);
  if (case_annotations_solution.result.solution)
    case_annotations_solution.left_out =
        leaveOneOut(views, *case_annotations_solution.result.solution);
  const std::string excess = case_annotations_solution.sigmaExcess();
  if (!excess.empty())
    case_annotations_solution.warnings.push_back(
        imprecisionWarning(case_annotations_solution.annotations.sigmas, excess));
  return case_annotations_solution;
}

CaseAnnotationsSolution solveCaseAnnotations(const Session& session, const std::string& case_id,
                                             bool together) {
  CaseAnnotations annotations = caseAnnotations(session, case_id, together);
  const SessionCase& session_case = *session.findCase(case_id);
  const SceneMesh scene = readKnownScene(session_case);
  return solveCaseAnnotations(std::move(annotations), annotationsGuess(session_case),
                              boxCorners(matchedBounds(scene.view())));
}

const Pose& annotationsGuess(const SessionCase& session_case) {
  return session_case.camera_from_station_working ? *session_case.camera_from_station_working
                                                  : session_case.camera_from_station_seed;
}

std::vector<Eigen::Vector3d> boxCorners(const BoundingBox& box) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1) != 0 ? box.maximum_m.x() : box.minimum_m.x(),
                         (i & 2) != 0 ? box.maximum_m.y() : box.minimum_m.y(),
                         (i & 4) != 0 ? box.maximum_m.z() : box.minimum_m.z());
  }
  return corners;
}

}  // namespace boresight::sessions
