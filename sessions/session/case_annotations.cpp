// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_annotations.h"

#include <utility>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/errors.h"
#include "sessions/io/scene_mesh.h"
#include "sessions/session/check_limits.h"
#include "sessions/session/input_check.h"

namespace boresight::sessions {
namespace {

Annotations annotationsOf(const Session& session, const std::string& case_id) {
  const auto found = session.annotations.find(case_id);
  return found == session.annotations.end() ? Annotations() : *found->second;
}

AnnotatedView viewOf(const Session& session, const SessionCase& one, const Pose& camera_from_rig) {
  AnnotatedView view;
  view.name = one.id;
  view.camera = one.camera;
  if (prepareCamera(view.camera) != Status::kOk)
    throw InputError("case " + one.id, "camera", "its parameters are not those of a camera");
  view.camera_from_rig = camera_from_rig;
  view.annotations = annotationsOf(session, one.id);
  return view;
}

}  // namespace

CaseAnnotations caseAnnotations(const Session& session, const std::string& case_id, bool together) {
  const SessionCase* chosen = &knownCase(session, case_id);
  CaseAnnotations made;
  made.requirement = requirementOf(session, *chosen);
  made.camera_from_end_effector = chosen->camera_from_end_effector;
  const auto add = [&](const SessionCase& one, const Pose& camera_from_rig) {
    made.case_ids.push_back(one.id);
    made.views.push_back(viewOf(session, one, camera_from_rig));
  };
  add(*chosen, Pose());
  if (!together || !chosen->rig) return made;
  for (const auto& other : session.cases) {
    if (other->id == case_id || !other->rig || other->rig->id != chosen->rig->id) continue;
    if (session.annotations.contains(other->id)) add(*other, other->rig->camera_from_rig);
  }
  made.rigid = made.views.size() > 1;
  if (made.rigid) made.views[0].camera_from_rig = chosen->rig->camera_from_rig;
  return made;
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
  return sigmaExcessText(covariance().value_or(Matrix6d::Zero()),
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
                                             std::span<const Eigen::Vector3d> station_m,
                                             bool robust) {
  CaseAnnotationsSolution made;
  made.annotations = std::move(annotations);
  const std::vector<AnnotatedView>& views = made.annotations.views;
  SolveAnnotationsOptions options;
  options.robust = robust;
  options.rig_from_station_guess = views[0].camera_from_rig.inverse() * camera_from_station_guess;
  made.warnings = geometryWarnings(views, &*options.rig_from_station_guess, station_m);
  made.result = solveAnnotations(views, options);
  if (made.result.solution) made.left_out = leaveOneOut(views, *made.result.solution);
  const std::string excess = made.sigmaExcess();
  if (!excess.empty()) made.warnings.push_back(imprecisionWarning(excess));
  return made;
}

CaseAnnotationsSolution solveCaseAnnotations(const Session& session, const std::string& case_id,
                                             bool together, bool robust) {
  CaseAnnotations annotations = caseAnnotations(session, case_id, together);
  const SessionCase& one = *session.findCase(case_id);
  const SceneMesh scene = readKnownScene(one.parts);
  return solveCaseAnnotations(std::move(annotations), annotationsGuess(one),
                              boxCorners(matchedBounds(scene.view())), robust);
}

const Pose& annotationsGuess(const SessionCase& one) {
  return one.camera_from_station_working ? *one.camera_from_station_working
                                         : one.camera_from_station_seed;
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
