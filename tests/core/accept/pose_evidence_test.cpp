// SPDX-License-Identifier: Apache-2.0
#include "core/accept/pose_evidence.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace boresight {
namespace {

/// Contours with a share of what could be expected, and edge support.
PoseEvidence evidenceWith(double share, double region_nats, double expected_nats,
                          double edge_support) {
  PoseEvidence evidence;
  for (ContourEvidence& view : evidence.contours) {
    view.places = view.outline_places = 500;
    view.expected_nats = view.outline_expected_nats = expected_nats;
    view.edges_nats = view.outline_nats = share * expected_nats;
  }
  evidence.region.nats = region_nats;
  evidence.edge_support = edge_support;
  return evidence;
}

/// The logistic function of resources/evidence/trust.md, within its limits and beyond them.
TEST(PoseEvidence, Probability_IsTheFittedLogisticFunction) {
  EXPECT_LT(PoseEvidence().probability(), 0.01);
  EXPECT_GT(evidenceWith(1.5, 1.0, 0.4, 0.6).probability(), 0.95);
  for (const double share : {-0.5, 0.4, 0.9, 1.4, 1.6})
    for (const double expected_nats : {0.1, 0.4, 3.0})
      for (const double region_nats : {-0.8, 0.4, 1.2})
        for (const double support : {0.0, 0.01, 0.03, 0.3, 0.6}) {
          PoseEvidence evidence = evidenceWith(share, region_nats, expected_nats, support);
          evidence.contours[0] = {};  // only the finest count
          const double log_support =
              std::log(std::max(0.02, support) / std::max(0.15, expected_nats));
          const double sum = -3.49 + 3.78 * std::min(1.5, share) + 0.98 * region_nats +
                             2.41 * std::clamp(log_support, -2.5, 0.2);
          EXPECT_NEAR(evidence.probability(), 1.0 / (1.0 + std::exp(-sum)), 1e-12);
        }
}

TEST(PoseEvidence, ScoreAndMeans_FollowTheirDefinitions) {
  PoseEvidence evidence = evidenceWith(1.0, 0.0, 0.4, 0.7);
  evidence.contours[0].outline_nats = 0.8;
  evidence.contours[0].quadrant_places = {500, 0, 0, 0};
  evidence.contours[0].quadrant_nats = {-0.6, 0.0, 0.0, 0.0};
  evidence.contours[1].place_length_px = 2.0;
  EXPECT_DOUBLE_EQ(evidence.strongest_nats(), 0.6);
  EXPECT_DOUBLE_EQ(evidence.weakest_nats(), (-0.6 + 0.4) / 2.0);
  EXPECT_DOUBLE_EQ(evidence.total_nats(), 0.4 * 500 * 2.0 / 8.0);
  EXPECT_NEAR(evidence.score(), std::asinh(5.0) + 0.5 * std::log(0.7), 1e-14);
  EXPECT_EQ(&evidence.finest(), &evidence.contours[1]);
}

TEST(PoseEvidence, Score_IsARatioOfEvidence) {
  for (const double total_nats : {-40.0, -0.3, 0.0, 0.02, 8.0, 1200.0})
    for (const double support : {0.0, 0.04, 0.05, 0.3, 1.0})
      EXPECT_NEAR(scoreOf(total_nats, support),
                  std::asinh(total_nats / 10.0) + 0.5 * std::log(std::max(0.05, support)), 1e-14);
  // The same scene with twice the number of pixels.
  EXPECT_NEAR(scoreOf(900.0, 0.5) - scoreOf(600.0, 0.5),
              scoreOf(1800.0, 0.5) - scoreOf(1200.0, 0.5), 1e-4);
}

}  // namespace
}  // namespace boresight
