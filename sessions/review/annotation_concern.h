// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sessions/checks/pose_quality.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

/// Quality of the pose of annotations, by the same measure as for a run's pose. Without a pose no
/// figure is known.
PoseQuality annotationQuality(const std::shared_ptr<const LoadedCase>& loaded,
                              const CaseAnnotationsSolution& solution, double sigmas);

/// Why the pose of annotations is not good enough.
struct AnnotationConcern {
  /// Sentences: residuals of more than three times the stated sigmas, a figure beyond the
  /// requirement, too few annotations to confirm a figure. "" when it is good enough.
  std::string text;
  /// Annotations of the case that a robust solution gives less than half the weight, by id.
  /// Determined when the residuals are too large or the solution is robust.
  std::vector<std::string> suspects;
  bool robust = false;  ///< the solution itself is robust
};
AnnotationConcern annotationConcern(const CaseAnnotationsSolution& solution,
                                    const PoseQuality& quality);

}  // namespace boresight::sessions
