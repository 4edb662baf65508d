// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/session/case_annotations.h"

namespace boresight::sessions {

/// Why the pose of annotations is not good enough, as a sentence: one sigma beyond the requirement,
/// or residuals of more than three times the stated sigmas. "" when it is good enough.
std::string annotationConcern(const CaseAnnotationsSolution& solution);

}  // namespace boresight::sessions
