// SPDX-License-Identifier: Apache-2.0
#include "core/edges/direction_distance.h"

#include <algorithm>
#include <array>

namespace boresight {
namespace {

constexpr int kStraight = 10;
constexpr int kDiagonal = 14;

/// What an edge of each direction costs, and no edge.
std::array<std::uint8_t, 256> costsFor(int direction) {
  std::array<std::uint8_t, 256> cost{};
  cost.fill(kFarthest);
  for (int other = 0; other < kEdgeDirections; ++other)
    cost[static_cast<std::size_t>(other)] = static_cast<std::uint8_t>(
        std::min(kFarthest, kStepOfDirection * directionsApart(other, direction)));
  return cost;
}

}  // namespace

void distanceToDirection(const DirectedEdges& edges, int direction,
                         std::span<std::uint8_t> distance) {
  const std::array<std::uint8_t, 256> cost = costsFor(direction);
  const int width = edges.width;
  const int height = edges.height;
  const auto count = static_cast<std::size_t>(width * height);
  for (std::size_t i = 0; i < count; ++i) distance[i] = cost[edges.direction[i]];
  const auto lower = [](std::uint8_t& value, int other) {
    if (other < value) value = static_cast<std::uint8_t>(other);
  };
  for (int y = 0; y < height; ++y) {
    std::uint8_t* row = distance.data() + y * width;
    if (y > 0) {
      const std::uint8_t* above = row - width;
      for (int x = 0; x < width; ++x) lower(row[x], above[x] + kStraight);
      for (int x = 1; x < width; ++x) lower(row[x], above[x - 1] + kDiagonal);
      for (int x = 0; x + 1 < width; ++x) lower(row[x], above[x + 1] + kDiagonal);
    }
    for (int x = 1; x < width; ++x) lower(row[x], row[x - 1] + kStraight);
  }
  for (int y = height - 1; y >= 0; --y) {
    std::uint8_t* row = distance.data() + y * width;
    if (y + 1 < height) {
      const std::uint8_t* below = row + width;
      for (int x = 0; x < width; ++x) lower(row[x], below[x] + kStraight);
      for (int x = 1; x < width; ++x) lower(row[x], below[x - 1] + kDiagonal);
      for (int x = 0; x + 1 < width; ++x) lower(row[x], below[x + 1] + kDiagonal);
    }
    for (int x = width - 2; x >= 0; --x) lower(row[x], row[x + 1] + kStraight);
  }
  std::uint64_t sum = 0;
  std::uint64_t known = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (edges.direction[i] == DirectedEdges::kUnseen) continue;
    sum += distance[i];
    ++known;
  }
  const auto mean = static_cast<std::uint8_t>(known > 0 ? sum / known : kFarthest);
  for (std::size_t i = 0; i < count; ++i)
    if (edges.direction[i] == DirectedEdges::kUnseen) distance[i] = mean;
}

}  // namespace boresight
