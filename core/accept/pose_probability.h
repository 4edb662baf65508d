// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/accept/contour_evidence.h"
#include "core/accept/edge_support.h"

namespace boresight {

/// What a pose's acceptance rests on: the evidence of its strongest kind of edges, half of that of
/// its weakest quadrant, and its edge support.
inline double acceptanceScore(const ContourEvidence& evidence, const EdgeSupport& support) {
  return evidence.strongest_nats() + 0.5 * evidence.weakest_nats() + support.share();
}

/// The probability that a pose that a search has found is right: logistic in the acceptance score,
/// fitted to poses of right and of foreign meshes searched in the same images (resources/evidence/trust.md).
double poseProbability(const ContourEvidence& evidence, const EdgeSupport& support);

}  // namespace boresight
