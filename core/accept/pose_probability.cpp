// SPDX-License-Identifier: Apache-2.0
#include "core/accept/pose_probability.h"

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kEven = 0.80;   ///< score at which half of the poses are correct
constexpr double kSlope = 12.0;  ///< per unit of the score

}  // namespace

double poseProbability(const ContourEvidence& evidence, const EdgeSupport& support) {
  return 1.0 / (1.0 + exp(kSlope * (kEven - acceptanceScore(evidence, support))));
}

}  // namespace boresight
