// SPDX-License-Identifier: Apache-2.0
#include "core/accept/pose_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kLinearTotal_nats = 10.0;
constexpr double kLeastScoredSupport = 0.05;

// The probability's logistic function.
constexpr double kIntercept = 3.49;
constexpr double kOfContours = 3.78;
constexpr double kOfRegion = 0.98;
constexpr double kOfSupport = 2.41;
constexpr double kMostShare = 1.5;
constexpr double kLeastSupport = 0.02;
constexpr double kLeastExpected_nats = 0.15;
constexpr double kLeastLogSupport = -2.5;
constexpr double kMostLogSupport = 0.2;

double asinh(double x) {
  const double magnitude = std::abs(x);
  const double result = log(magnitude + std::sqrt(magnitude * magnitude + 1.0));
  return x < 0.0 ? -result : result;
}

/// Mean of a measure over the views.
double meanOf(const std::array<ContourEvidence, kEvidenceViews>& contours,
              double (ContourEvidence::*measure)() const) {
  double sum = 0.0;
  for (const ContourEvidence& view : contours) sum += (view.*measure)();
  return sum / kEvidenceViews;
}

}  // namespace

double PoseEvidence::strongest_nats() const {
  return meanOf(contours, &ContourEvidence::strongest_nats);
}

double PoseEvidence::weakest_nats() const {
  return meanOf(contours, &ContourEvidence::weakest_nats);
}

double PoseEvidence::score() const { return scoreOf(total_nats(), edge_support); }

double scoreOf(double total_nats, double edge_support) {
  return asinh(total_nats / kLinearTotal_nats) +
         0.5 * log(std::max(kLeastScoredSupport, edge_support));
}

double PoseEvidence::probability() const {
  const double contours_share = std::min(kMostShare, finest().shareOfExpected());
  const double support = std::clamp(log(std::max(kLeastSupport, edge_support) /
                                        std::max(kLeastExpected_nats, finest().expected_nats)),
                                    kLeastLogSupport, kMostLogSupport);
  return 1.0 / (1.0 + exp(kIntercept - kOfContours * contours_share - kOfRegion * region.nats -
                          kOfSupport * support));
}

}  // namespace boresight
