// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/accept/contour_evidence.h"
#include "core/base/random.h"
#include "core/edges/direction_distance.h"

namespace boresight {
namespace {

constexpr int kSide = 160;

/// The outline of a square in an image of directed edges.
class ContourEvidenceTest : public testing::Test {
 protected:
  ContourEvidenceTest() : direction_(kSide * kSide, DirectedEdges::kNone), block_(1 << 20) {
    edges_.direction = direction_;
    edges_.width = edges_.height = kSide;
    Arena arena(block_);
    meter_.create(direction_.size(), arena);
  }
  void set(int x, int y, std::uint8_t value) {
    direction_[static_cast<std::size_t>(y * kSide + x)] = value;
  }
  /// Calls `visit(x, y, direction)` along a square of 80 px.
  template <class Visit>
  static void visitSquare(Visit&& visit) {
    for (int i = 40; i < 120; ++i) {
      visit(40, i, 0);
      visit(119, i, 0);
      visit(i, 40, 4);
      visit(i, 119, 4);
    }
  }
  void drawSquare() {
    visitSquare([&](int x, int y, int d) { set(x, y, static_cast<std::uint8_t>(d)); });
  }
  ContourEvidence measure(int shift_px = 0, int turned = 0) {
    meter_.clear();
    visitSquare([&](int x, int y, int d) {
      meter_.add({static_cast<std::int16_t>(x + shift_px), static_cast<std::int16_t>(y + shift_px),
                  static_cast<std::uint8_t>((d + turned) % kEdgeDirections), true});
    });
    meter_.begin(edges_);
    return meter_.measure(80.0);
  }

  std::vector<std::uint8_t> direction_;
  std::vector<std::byte> block_;
  DirectedEdges edges_;
  ContourEvidenceMeter meter_;
};

TEST_F(ContourEvidenceTest, OutlineOnItsEdges_IsStrongEvidence) {
  drawSquare();
  const ContourEvidence evidence = measure();
  EXPECT_EQ(evidence.places, 320);
  EXPECT_EQ(evidence.outline_places, 320);
  EXPECT_GT(evidence.outline_nats, 0.8);
  EXPECT_GT(evidence.weakest_nats(), 0.7);
}

TEST_F(ContourEvidenceTest, ImageWithoutEdges_GivesNegativeEvidence) {
  // Everything is far from edges, around the places as well: nearly log(0.4).
  EXPECT_NEAR(measure().outline_nats, std::log(0.4), 0.01);
}

TEST_F(ContourEvidenceTest, DisplacedOrTurnedOutline_IsNoEvidence) {
  drawSquare();
  EXPECT_LT(measure(7).outline_nats, 0.1);
  EXPECT_LT(measure(0, 4).outline_nats, 0.0) << "edges of other directions";
}

TEST_F(ContourEvidenceTest, EdgesEverywhere_GiveNoEvidence) {
  Random random(5);
  for (auto& direction : direction_)
    if (random.below(3) == 0) direction = static_cast<std::uint8_t>(random.below(8));
  drawSquare();
  EXPECT_LT(measure().outline_nats, 0.45);
}

TEST_F(ContourEvidenceTest, MissingCorner_IsTheWeakestQuadrant) {
  drawSquare();
  for (int i = 30; i < 80; ++i)
    for (int j = 30; j < 80; ++j) set(i, j, DirectedEdges::kNone);
  const ContourEvidence evidence = measure();
  EXPECT_LT(evidence.weakest_nats(), 0.0);
  EXPECT_GT(evidence.outline_nats, 0.3);
  EXPECT_EQ(evidence.weakest_nats(), evidence.quadrant_nats[0]);
}

TEST_F(ContourEvidenceTest, UnknownPixels_DoNotCount) {
  drawSquare();
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < kSide; ++x) set(x, y, DirectedEdges::kUnseen);
  const ContourEvidence evidence = measure();
  EXPECT_LT(evidence.places, 320 / 2 + 10);
  EXPECT_GT(evidence.outline_nats, 0.7);
}

TEST_F(ContourEvidenceTest, NoPlaces_GiveZero) {
  meter_.clear();
  meter_.begin(edges_);
  const ContourEvidence evidence = meter_.measure(80.0);
  EXPECT_EQ(evidence.places, 0);
  EXPECT_EQ(evidence.strongest_nats(), 0.0);
  EXPECT_EQ(evidence.weakest_nats(), 0.0);
}

/// The expectation of the evidence at random right poses, by drawing intervals from
/// m = 0.6 p + 0.4 b with b counted by hand.
TEST_F(ContourEvidenceTest, Expectation_IsTheMeanOverDrawnIntervals) {
  drawSquare();
  Random random(9);
  for (auto& direction : direction_)
    if (random.below(12) == 0) direction = static_cast<std::uint8_t>(random.below(8));
  std::vector<std::uint8_t> distance(direction_.size());
  const EvidencePlace place{60, 60, 0, false};
  distanceToDirection(edges_, 0, distance);
  const double window_px = 30.0;  // no sample of the window is the place itself
  const PlaceEvidence measured = evidenceOfPlace(place, edges_, distance, window_px);
  // The nats of each interval, read by placing a distance of that interval at the place.
  const double p[4] = {0.50, 0.33, 0.17, 0.0};
  double share[4];
  double nats[4];
  const std::uint8_t inside[4] = {5, 18, 30, 50};
  const auto at = static_cast<std::size_t>(60 * kSide + 60);
  for (int k = 0; k < 4; ++k) {
    distance[at] = inside[k];
    nats[k] = evidenceOfPlace(place, edges_, distance, window_px).nats;
  }
  // exp(nats) = (0.6 p + 0.4 b) / b, solved for b; the rest is in the last interval.
  double around = 1.0;
  for (int k = 0; k < 4; ++k) {
    const double b = k < 3 ? 0.6 * p[k] / (std::exp(nats[k]) - 0.4) : around;
    around -= b;
    share[k] = 0.6 * p[k] + 0.4 * b;
  }
  double expected_nats = 0.0;
  for (int k = 0; k < 4; ++k) expected_nats += share[k] * nats[k];
  EXPECT_NEAR(measured.expected_nats, expected_nats, 1e-9);
  EXPECT_GT(expected_nats, 0.0);
}

TEST_F(ContourEvidenceTest, RightPoseAmongPrint_HasItsShareOfLittleEvidence) {
  drawSquare();
  const ContourEvidence plain = measure();
  Random random(5);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      if (random.below(4) == 0 && edges_.at(x, y) == DirectedEdges::kNone)
        set(x, y, static_cast<std::uint8_t>(random.below(8)));
  const ContourEvidence print = measure();
  EXPECT_LT(print.strongest_nats(), 0.6 * plain.strongest_nats());
  EXPECT_GT(print.shareOfExpected(), 0.8);
  EXPECT_LT(measure(7).shareOfExpected(), 0.5 * print.shareOfExpected());
}

}  // namespace
}  // namespace boresight
