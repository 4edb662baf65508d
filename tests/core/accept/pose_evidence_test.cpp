// SPDX-License-Identifier: Apache-2.0
#include "core/accept/pose_evidence.h"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight {
namespace {

/// Contours with a share of what could be expected, and edge support.
PoseEvidence evidenceWith(double share, double region_nats, double edge_support) {
  PoseEvidence evidence;
  for (ContourEvidence& view : evidence.contours) {
    view.places = view.outline_places = 500;
    view.expected_nats = view.outline_expected_nats = 0.4;
    view.edges_nats = view.outline_nats = 0.4 * share;
  }
  evidence.region.nats = region_nats;
  evidence.edge_support = edge_support;
  return evidence;
}

TEST(PoseEvidence, Probability_GrowsWithEachOfItsParts) {
  for (int part = 0; part < 3; ++part) {
    double before = 0.0;
    for (int i = 1; i <= 10; ++i) {
      const double grown = 0.1 * i;
      const PoseEvidence evidence = evidenceWith(part == 0 ? grown : 0.9, part == 1 ? grown : 0.4,
                                                 part == 2 ? 0.04 * i : 0.3);
      EXPECT_GT(evidence.probability(), before) << part << ' ' << i;
      EXPECT_LE(evidence.probability(), 1.0);
      before = evidence.probability();
    }
  }
}

TEST(PoseEvidence, NothingMeasured_IsImprobable) {
  EXPECT_LT(PoseEvidence().probability(), 0.01);
  EXPECT_GT(evidenceWith(1.5, 1.0, 0.6).probability(), 0.95);
}

/// Twice the length of explained edges counts more than a better mean over fewer edges.
TEST(PoseEvidence, Score_PrefersThePoseThatExplainsMore) {
  PoseEvidence few = evidenceWith(1.2, 0.5, 0.5);
  PoseEvidence many = evidenceWith(1.0, 0.5, 0.5);
  for (ContourEvidence& view : many.contours) view.place_length_px = 2.0;
  EXPECT_GT(many.score(), few.score());
  few.edge_support += 0.1;
  EXPECT_GT(few.score(), evidenceWith(1.2, 0.5, 0.5).score());
}

TEST(PoseEvidence, Means_AreOverTheViews) {
  PoseEvidence evidence = evidenceWith(1.0, 0.0, 0.0);
  evidence.contours[0].outline_nats = 0.8;
  EXPECT_DOUBLE_EQ(evidence.strongest_nats(), 0.6);
  EXPECT_EQ(&evidence.finest(), &evidence.contours[1]);
}

}  // namespace
}  // namespace boresight
