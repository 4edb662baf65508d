// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/accept/contour_evidence.h"
#include "core/accept/edge_support.h"

namespace boresight {

/// Acceptance score of a pose: the evidence of its strongest kind of edges, half of the evidence of
/// its weakest quadrant, and its edge support.
inline double acceptanceScore(const ContourEvidence& evidence, const EdgeSupport& support) {
  return evidence.strongest_nats() + 0.5 * evidence.weakest_nats() + support.share();
}

/// Probability that a pose found by a search is correct: logistic in the acceptance score, fitted
/// to poses of correct and of foreign meshes searched in the same images
/// (resources/evidence/trust.md).
double poseProbability(const ContourEvidence& evidence, const EdgeSupport& support);

}  // namespace boresight
