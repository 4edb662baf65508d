// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/run/trace.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// By how much the sigmas of a run's pose that must fit into the requirement exceed it, as a
/// clause: "1.2 mm across the view axis at the camera, 3.1 times the 0.4 mm required"; "" when they
/// fit, or the run has no pose. The covariance is the image's alone; the limits are the session's.
std::string runSigmaExcess(const Session& session, const SessionCase& session_case,
                           const LocalizationTrace& run);

/// Why the pose of annotations is not good enough, as a sentence: one sigma beyond the requirement,
/// or residuals of more than three times the stated sigmas. "" when it is good enough.
std::string annotationConcern(const CaseAnnotationsSolution& solution);

}  // namespace boresight::sessions
