// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/annotation_concern.h"

#include <algorithm>
#include <utility>

#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check.h"

namespace boresight::sessions {
namespace {

constexpr double kLeastWeight = 0.5;

std::vector<std::string> doubted(const CaseAnnotations& annotations,
                                 const AnnotationsSolution& solution) {
  std::vector<std::string> ids;
  for (const SolvedAnnotation& annotation : solution.annotations)
    if (annotation.address.view == 0 && annotation.projected && annotation.weight < kLeastWeight)
      ids.push_back(annotationId(annotations.views, annotation.address));
  return ids;
}

void switchOff(std::vector<AnnotatedView>& views, const AnnotationAddress& at) {
  Annotations& annotations = views[at.view].annotations;
  if (at.kind == AnnotationKind::kPoint)
    annotations.points[at.index].enabled = false;
  else
    annotations.lines[at.index].enabled = false;
}

/// A pose that bad annotations pull little: by least squares without the worst one after the other,
/// until the rest fits or hardly determines it.
Pose poseOfBestRest(const CaseAnnotationsSolution& solution) {
  std::vector<AnnotatedView> views = solution.annotations.views;
  AnnotationsSolution rest = *solution.result.solution;
  while (rest.noise_factor > kMostNoise && rest.degrees_of_freedom > 2) {
    const auto worst =
        std::ranges::max_element(rest.annotations, {}, &SolvedAnnotation::normalized);
    switchOff(views, worst->address);
    SolveAnnotationsOptions options;
    options.rig_from_station_guess = rest.rig_from_station;
    AnnotationsResult next = solveAnnotations(views, options);
    if (!next.solution) break;
    rest = std::move(*next.solution);
  }
  return rest.rig_from_station;
}

/// Least squares spread one bad annotation's error over all: robust weights tell them apart.
std::vector<std::string> doubtedByRobust(const CaseAnnotationsSolution& solution) {
  SolveAnnotationsOptions options;
  options.robust = true;
  options.rig_from_station_guess = poseOfBestRest(solution);
  const AnnotationsResult robust = solveAnnotations(solution.annotations.views, options);
  return robust.solution ? doubted(solution.annotations, *robust.solution)
                         : std::vector<std::string>();
}

}  // namespace

PoseQuality annotationQuality(const std::shared_ptr<const LoadedCase>& loaded,
                              const CaseAnnotationsSolution& solution, double sigmas) {
  ReviewSubject subject;
  subject.loaded = loaded;
  subject.requirement = solution.annotations.requirement;
  subject.source = PoseSource::kAnnotation;
  if (const auto pose = solution.camera_from_station()) {
    subject.camera_from_station = *pose;
    subject.covariance =
        poseCovariance(loaded->source, loaded->scene.view(), *pose, *solution.covariance());
  }
  return poseQuality(subject, sigmas);
}

AnnotationConcern annotationConcern(const CaseAnnotationsSolution& solution,
                                    const PoseQuality& quality) {
  AnnotationConcern concern;
  if (!solution.result.solution) return concern;
  const AnnotationsSolution& solved = *solution.result.solution;
  concern.robust = std::ranges::any_of(
      solved.annotations, [](const SolvedAnnotation& each) { return each.weight < 1.0; });
  const bool noisy = solved.noise_factor > kMostNoise;
  if (concern.robust)
    concern.suspects = doubted(solution.annotations, solved);
  else if (noisy)
    concern.suspects = doubtedByRobust(solution);
  if (noisy)
    concern.text =
        "The residuals are " + sentenceNumber(solved.noise_factor) + " times the stated sigmas.";
  if (quality.worst() == nullptr) return concern;
  const std::string precision = quality.holds() ? unconfirmedSigmasText(solved.degrees_of_freedom)
                                                : "Pose known to " + quality.text() + ".";
  if (!precision.empty()) concern.text += (concern.text.empty() ? "" : " ") + precision;
  return concern;
}

}  // namespace boresight::sessions
