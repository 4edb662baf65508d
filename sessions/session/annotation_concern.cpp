// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/annotation_concern.h"

#include "sessions/session/check.h"

namespace boresight::sessions {

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
