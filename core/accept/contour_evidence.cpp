// SPDX-License-Identifier: Apache-2.0
#include "core/accept/contour_evidence.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/edges/direction_distance.h"

namespace boresight {
namespace {

constexpr std::size_t kIntervals = 4;
using Shares = std::array<double, kIntervals>;
/// Upper ends of the intervals of d, in units of kDistanceUnit_px, and their shares at correct
/// poses.
constexpr std::array<int, kIntervals - 1> kUpTo = {12, 23, 36};
constexpr Shares kAtRightPoses = {0.50, 0.33, 0.17, 0.0};
constexpr double kTrusted = 0.6;  ///< share of a right pose's edges that the image shows
constexpr int kSamples = 12;      ///< of the window, along each side

/// Interval of each distance, as a count of 1 in its 16 bits of a word: one addition counts.
constexpr int kCountBits = 16;
static_assert(kIntervals * kCountBits == 64 && kSamples * kSamples < 1 << kCountBits);
constexpr std::array<std::uint64_t, 256> kCountOf = [] {
  std::array<std::uint64_t, 256> counts{};
  for (int distance = 0; distance < 256; ++distance) {
    int interval = 0;
    for (const int up_to : kUpTo)
      if (distance > up_to) ++interval;
    nth(counts, distance) = std::uint64_t{1} << (kCountBits * interval);
  }
  return counts;
}();

/// Shares of the intervals around a place; one count more in each, so that none is 0.
Shares sharesAround(const EvidencePlace& place, const DirectedEdges& edges,
                    std::span<const std::uint8_t> distance, double window_px) {
  std::array<int, kSamples> offset{};
  for (int i = 0; i < kSamples; ++i)
    nth(offset, i) = static_cast<int>(std::floor(window_px * ((i + 0.5) / kSamples - 0.5)));
  std::uint64_t counts = 0;
  for (const int down : offset) {
    const int y = place.y + down;
    if (y < 0 || y >= edges.height) continue;
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(edges.width);
    for (const int right : offset) {
      const int x = place.x + right;
      if (static_cast<unsigned>(x) >= static_cast<unsigned>(edges.width)) continue;
      const std::size_t at = row + static_cast<std::size_t>(x);
      if (edges.direction[at] != DirectedEdges::kUnseen) counts += kCountOf[distance[at]];
    }
  }
  std::array<int, kIntervals> count{};
  int all = 0;
  for (std::size_t k = 0; k < kIntervals; ++k) {
    count[k] = static_cast<int>(counts >> (kCountBits * k) & ((1U << kCountBits) - 1));
    all += count[k];
  }
  Shares shares{};
  for (std::size_t k = 0; k < kIntervals; ++k)
    shares[k] = (count[k] + 1.0) / (all + static_cast<double>(kIntervals));
  return shares;
}

double meanOf(double sum, std::int32_t count) { return count > 0 ? sum / count : 0.0; }

}  // namespace

PlaceEvidence evidenceOfPlace(const EvidencePlace& place, const DirectedEdges& edges,
                              std::span<const std::uint8_t> distance, double window_px) {
  const Shares around = sharesAround(place, edges, distance, window_px);
  const std::uint64_t count = kCountOf[nth(distance, place.y * edges.width + place.x)];
  const auto observed = static_cast<std::size_t>(std::countr_zero(count) / kCountBits);
  PlaceEvidence evidence;
  for (std::size_t k = 0; k < kIntervals; ++k) {
    const double share = kTrusted * kAtRightPoses[k] + (1.0 - kTrusted) * around[k];
    const double nats = log(share / around[k]);
    if (k == observed) evidence.nats = nats;
    evidence.expected_nats += share * nats;
  }
  return evidence;
}

double ContourEvidence::shareOfExpected() const {
  const double of_edges = expected_nats > 0.0 ? edges_nats / expected_nats : 0.0;
  const double of_outline =
      outline_expected_nats > 0.0 ? outline_nats / outline_expected_nats : 0.0;
  return of_edges < -kContradicting ? of_edges : std::max(of_edges, of_outline);
}

double ContourEvidence::weakest_nats() const {
  double least = strongest_nats();
  for (std::size_t q = 0; q < quadrant_nats.size(); ++q)
    if (10 * quadrant_places[q] >= places) least = std::min(least, quadrant_nats[q]);
  return least;
}

void ContourEvidenceMeter::create(std::size_t pixels, Arena& arena) {
  distance_ = arena.allocate<std::uint8_t>(pixels);
  places_ = arena.allocate<EvidencePlace>(kMaxPlaces);
}

void ContourEvidenceMeter::begin(const DirectedEdges& edges) {
  edges_ = &edges;
  known_ = 0;
}

/// Distances to the edges of a direction.
std::span<const std::uint8_t> ContourEvidenceMeter::distanceTo(int direction) {
  const std::size_t pixels =
      static_cast<std::size_t>(edges_->width) * static_cast<std::size_t>(edges_->height);
  const bool keeps = kEdgeDirections * pixels <= distance_.size();
  const std::size_t first = keeps ? static_cast<std::size_t>(direction) * pixels : 0;
  const std::span<std::uint8_t> distance = distance_.subspan(first, pixels);
  const unsigned bit = 1U << direction;
  if ((known_ & bit) == 0) distanceToDirection(*edges_, direction, distance);
  if (keeps) known_ |= bit;
  return distance;
}

ContourEvidence ContourEvidenceMeter::measure(double size_px) {
  const DirectedEdges& edges = *edges_;
  ContourEvidence evidence;
  evidence.place_length_px = place_length_px_;
  const auto places = places_.first(static_cast<std::size_t>(count_));
  std::int64_t sum_x = 0;
  std::int64_t sum_y = 0;
  for (const EvidencePlace& place : places) {
    sum_x += place.x;
    sum_y += place.y;
  }
  const std::int64_t count = std::max(count_, 1);
  for (int direction = 0; direction < kEdgeDirections; ++direction) {
    const std::span<const std::uint8_t> distance = distanceTo(direction);
    for (const EvidencePlace& place : places) {
      if (place.direction != direction || place.x < 0 || place.y < 0 || place.x >= edges.width ||
          place.y >= edges.height || edges.at(place.x, place.y) == DirectedEdges::kUnseen)
        continue;
      const auto [nats, expected_nats] =
          evidenceOfPlace(place, edges, distance, kEvidenceWindow * size_px);
      const auto quadrant = static_cast<std::size_t>((place.x * count > sum_x ? 1 : 0) +
                                                     (place.y * count > sum_y ? 2 : 0));
      evidence.edges_nats += nats;
      evidence.expected_nats += expected_nats;
      ++evidence.places;
      evidence.quadrant_nats[quadrant] += nats;
      ++evidence.quadrant_places[quadrant];
      if (!place.outline) continue;
      evidence.outline_nats += nats;
      evidence.outline_expected_nats += expected_nats;
      ++evidence.outline_places;
    }
  }
  evidence.edges_nats = meanOf(evidence.edges_nats, evidence.places);
  evidence.outline_nats = meanOf(evidence.outline_nats, evidence.outline_places);
  evidence.expected_nats = meanOf(evidence.expected_nats, evidence.places);
  evidence.outline_expected_nats = meanOf(evidence.outline_expected_nats, evidence.outline_places);
  for (std::size_t q = 0; q < evidence.quadrant_nats.size(); ++q)
    evidence.quadrant_nats[q] = meanOf(evidence.quadrant_nats[q], evidence.quadrant_places[q]);
  return evidence;
}

}  // namespace boresight
