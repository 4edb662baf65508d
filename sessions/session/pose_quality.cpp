// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/pose_quality.h"

#include "sessions/evaluation/pose_error.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

std::string runSigmaExcess(const Session& session, const SessionCase& session_case,
                           const LocalizationTrace& run) {
  if (!run.converged()) return "";
  const double sigmas = checkLimits(session.review.preset, session.review.limits).sigmas;
  return sigmaExcessText(sigmas * sigmas * run.covariance, session_case.camera_from_end_effector,
                         requirementOf(session, session_case));
}

std::string annotationConcern(const CaseAnnotationsSolution& solution) {
  constexpr double kMostNoise = 3.0;
  if (!solution.result.solution) return "";
  const std::string excess = solution.sigmaExcess();
  if (!excess.empty()) return "One sigma is " + excess + ".";
  const double noise = solution.result.solution->noise_factor;
  if (noise <= kMostNoise) return "";
  return "The residuals are " + sentenceNumber(noise) + " times the stated sigmas.";
}

}  // namespace boresight::sessions
