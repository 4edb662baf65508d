// SPDX-License-Identifier: Apache-2.0
#include "core/accept/paired_support.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

Pose alongBar(const Case& scene, double pitches) {
  Pose moved = scene.truth;
  moved.translation_m += scene.truth.matrix().col(0) * (pitches * kPitch_m);
  return moved;
}

PairedSupport compared(const Case& scene, const Pose& own, const Pose& other) {
  const Rendering one = renderEdges(scene.solid, scene.camera, own);
  const Rendering two = renderEdges(scene.solid, scene.camera, other);
  return comparePredictions(one.edges, two.edges, 0, scene.picture->view(), nullptr);
}

TEST(PairedSupport, TheTruthIsFarAheadOfANeighbourWhileTheEndsAreSeen) {
  const Case scene = railCase(Ends::kSeen, 0.0, 1.0, 1);
  for (const double pitches : {-2.0, -1.0, 1.0, 2.0}) {
    SCOPED_TRACE(pitches);
    EXPECT_GT(compared(scene, scene.truth, alongBar(scene, pitches)).nats(), 50.0);
  }
}

TEST(PairedSupport, HasNothingToSayWhereNoEndIsInThePicture) {
  const Case scene = railCase(Ends::kOutside, 0.0, 1.0, 1);
  EXPECT_LT(std::abs(compared(scene, scene.truth, alongBar(scene, 1.0)).nats()), 10.0);
}

TEST(PairedSupport, IsTheOppositeTheOtherWayRound) {
  const Case scene = railCase(Ends::kSeen, 0.0, 1.0, 1);
  const PairedSupport there = compared(scene, scene.truth, alongBar(scene, 1.0));
  const PairedSupport back = compared(scene, alongBar(scene, 1.0), scene.truth);
  EXPECT_EQ(there.nats(), -back.nats());
  EXPECT_EQ(there.own, back.other);
  EXPECT_EQ(compared(scene, scene.truth, scene.truth).nats(), 0.0);
}

/// Against the probabilities of the two outcomes, written out.
TEST(PairedSupport, NatsAreALogRatioOfProbabilities) {
  PairedSupport support;
  support.own = 80;
  support.own_covered = 60;
  support.other = 40;
  support.other_covered = 8;
  support.common = 1000;
  support.common_covered = 800;
  support.displaced = 1000;
  support.displaced_covered = 250;
  const auto probability = [](double share, int count, int covered) {
    return covered * std::log(share) + (count - covered) * std::log(1.0 - share);
  };
  const double under_own = probability(0.8, 80, 60) + probability(0.25, 40, 8);
  const double under_other = probability(0.25, 80, 60) + probability(0.8, 40, 8);
  EXPECT_NEAR(support.nats(), (under_own - under_other) / 8.0, 1e-9);
  support.common_covered = 260;  // edges that are there are seen no more often than by chance
  EXPECT_EQ(support.nats(), 0.0);
  EXPECT_EQ(PairedSupport().nats(), 0.0);
}

}  // namespace
}  // namespace boresight::test
