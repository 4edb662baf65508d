// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/accept/contour_evidence.h"
#include "core/base/random.h"
#include "core/edges/direction_distance.h"

namespace boresight {
namespace {

constexpr int kSide = 160;

bool isKnown(const DirectedEdges& edges, int x, int y) {
  return x >= 0 && y >= 0 && x < edges.width && y < edges.height &&
         edges.at(x, y) != DirectedEdges::kUnseen;
}

/// Interval of a distance: up to 1.2, 2.3 and 3.6 px, and beyond.
std::size_t intervalOf(int distance) {
  return distance <= 12 ? 0 : distance <= 23 ? 1 : distance <= 36 ? 2 : 3;
}

PlaceEvidence placeByDefinition(const EvidencePlace& place, const DirectedEdges& edges,
                                std::span<const std::uint8_t> distance, double window_px) {
  constexpr std::array<double, 4> kAtRightPoses = {0.50, 0.33, 0.17, 0.0};
  const auto distanceAt = [&](int x, int y) {
    return distance[static_cast<std::size_t>(y * edges.width + x)];
  };
  const auto sampleOffset = [&](int i) {
    return static_cast<int>(std::floor(window_px * ((i + 0.5) / 12.0 - 0.5)));
  };
  std::array<double, 4> around = {1.0, 1.0, 1.0, 1.0};
  double all = 4.0;
  for (int i = 0; i < 144; ++i) {
    const int x = place.x + sampleOffset(i % 12);
    const int y = place.y + sampleOffset(i / 12);
    if (!isKnown(edges, x, y)) continue;
    around[intervalOf(distanceAt(x, y))] += 1.0;
    all += 1.0;
  }
  PlaceEvidence evidence;
  for (std::size_t k = 0; k < 4; ++k) {
    const double background = around[k] / all;
    const double expected = 0.6 * kAtRightPoses[k] + 0.4 * background;
    const double nats = std::log(expected / background);
    if (k == intervalOf(distanceAt(place.x, place.y))) evidence.nats = nats;
    evidence.expected_nats += expected * nats;
  }
  return evidence;
}

/// No places; then places in an image that is small enough for its distances to be kept, and in one
/// that is not.
TEST(ContourEvidence, RandomEdgesAndPlaces_MatchTheDefinition) {
  std::vector<std::uint8_t> direction(kSide * kSide, DirectedEdges::kNone);
  DirectedEdges edges{direction, kSide, kSide};
  std::vector<std::byte> block(1 << 20);
  Arena arena(block);
  ContourEvidenceMeter meter;
  meter.create(direction.size(), arena);
  meter.clear();
  meter.begin(edges);
  const ContourEvidence none = meter.measure(80.0);
  EXPECT_EQ(none.places, 0);
  EXPECT_EQ(none.strongest_nats(), 0.0);
  EXPECT_EQ(none.weakest_nats(), 0.0);
  Random random(9);
  const auto below = [&random](int end) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(end)));
  };
  for (int trial = 0; trial < 8; ++trial) {
    edges.width = trial % 2 == 0 ? 61 : 121;
    edges.height = trial % 2 == 0 ? 43 : 90;
    for (std::uint8_t& pixel : direction)
      pixel = static_cast<std::uint8_t>(below(12) == 0 ? below(8) : DirectedEdges::kNone);
    for (int y = 20; y < 30; ++y)
      for (int x = 10; x < 30; ++x)
        direction[static_cast<std::size_t>(y * edges.width + x)] = DirectedEdges::kUnseen;
    std::vector<EvidencePlace> places;
    for (int i = 0; i < 300; ++i)
      places.push_back({static_cast<std::int16_t>(below(edges.width + 6) - 3),
                        static_cast<std::int16_t>(below(edges.height + 6) - 3),
                        static_cast<std::uint8_t>(below(8)), below(3) == 0});
    // Corners of the image, and places of which one quadrant has few.
    places.push_back({0, 0, 1, true});
    places.push_back({static_cast<std::int16_t>(edges.width - 1),
                      static_cast<std::int16_t>(edges.height - 1), 7, false});
    meter.begin(edges);
    for (const double size_px : {30.0, 170.0}) {
      meter.clear(2.5);
      for (const EvidencePlace& place : places) meter.add(place);
      const ContourEvidence measured = meter.measure(size_px);
      double middle_x = 0.0;
      double middle_y = 0.0;
      for (const EvidencePlace& place : places) {
        middle_x += place.x / static_cast<double>(places.size());
        middle_y += place.y / static_cast<double>(places.size());
      }
      ContourEvidence sum;
      std::vector<std::uint8_t> distance(direction.size());
      for (const EvidencePlace& place : places) {
        if (!isKnown(edges, place.x, place.y)) continue;
        distanceToDirection(edges, place.direction, distance);
        const PlaceEvidence of = placeByDefinition(place, edges, distance, 0.2 * size_px);
        const std::size_t quadrant =
            (place.x > middle_x ? 1u : 0u) + (place.y > middle_y ? 2u : 0u);
        ++sum.places;
        sum.edges_nats += of.nats;
        sum.expected_nats += of.expected_nats;
        ++sum.quadrant_places[quadrant];
        sum.quadrant_nats[quadrant] += of.nats;
        if (!place.outline) continue;
        ++sum.outline_places;
        sum.outline_nats += of.nats;
        sum.outline_expected_nats += of.expected_nats;
      }
      ASSERT_GT(sum.outline_places, 50);
      EXPECT_EQ(measured.place_length_px, 2.5);
      EXPECT_EQ(measured.places, sum.places);
      EXPECT_EQ(measured.outline_places, sum.outline_places);
      EXPECT_EQ(measured.quadrant_places, sum.quadrant_places);
      EXPECT_NEAR(measured.edges_nats, sum.edges_nats / sum.places, 1e-12);
      EXPECT_NEAR(measured.expected_nats, sum.expected_nats / sum.places, 1e-12);
      EXPECT_NEAR(measured.outline_nats, sum.outline_nats / sum.outline_places, 1e-12);
      EXPECT_NEAR(measured.outline_expected_nats, sum.outline_expected_nats / sum.outline_places,
                  1e-12);
      for (std::size_t q = 0; q < 4; ++q)
        EXPECT_NEAR(measured.quadrant_nats[q], sum.quadrant_nats[q] / sum.quadrant_places[q],
                    1e-12);
    }
  }
}

TEST(ContourEvidence, Summaries_FollowTheirDefinitions) {
  ContourEvidence evidence;
  EXPECT_EQ(evidence.shareOfExpected(), 0.0);
  evidence.places = 100;
  evidence.place_length_px = 3.0;
  evidence.edges_nats = 0.5;
  evidence.outline_nats = 0.3;
  evidence.expected_nats = 0.25;
  EXPECT_EQ(evidence.shareOfExpected(), 2.0);
  evidence.outline_expected_nats = 0.1;
  EXPECT_NEAR(evidence.shareOfExpected(), 3.0, 1e-12);
  EXPECT_EQ(evidence.total_nats(), 150.0);
  evidence.edges_nats = -0.07;
  EXPECT_NEAR(evidence.shareOfExpected(), 3.0, 1e-12);
  evidence.edges_nats = -0.08;
  EXPECT_NEAR(evidence.shareOfExpected(), -0.32, 1e-12) << "the edges together contradict";
  evidence.edges_nats = 0.5;
  EXPECT_EQ(evidence.strongest_nats(), 0.5);
  evidence.quadrant_nats = {-1.0, 0.2, 0.9, 0.4};
  evidence.quadrant_places = {9, 10, 41, 40};
  EXPECT_EQ(evidence.weakest_nats(), 0.2) << "quadrants with a tenth of the places";
  evidence.outline_nats = 0.6;
  evidence.quadrant_places = {};
  EXPECT_EQ(evidence.weakest_nats(), 0.6);
}

}  // namespace
}  // namespace boresight
