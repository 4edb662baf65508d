// SPDX-License-Identifier: Apache-2.0
#include "core/edges/direction_distance.h"

#include <algorithm>
#include <array>

namespace boresight {
namespace {

constexpr int kStraight = 10;
constexpr int kDiagonal = 14;

/// Initial cost of an edge of each direction, and of no edge.
std::array<std::uint8_t, 256> costsFor(int direction) {
  std::array<std::uint8_t, 256> cost{};
  cost.fill(kFarthest);
  for (int edge_direction = 0; edge_direction < kEdgeDirections; ++edge_direction)
    cost[static_cast<std::size_t>(edge_direction)] = static_cast<std::uint8_t>(
        std::min(kFarthest, kStepOfDirection * directionsApart(edge_direction, direction)));
  return cost;
}

using Value = std::uint8_t;
constexpr int kPadding = 8;  ///< px on both sides of a row, beyond the largest distance
using PaddedRow = std::array<Value, DirectedEdgeDetector::kMaxWidth + 2 * kPadding>;
static_assert(kPadding * kStraight > kFarthest && kFarthest + 4 * kStraight < 256);

Value least(Value value, int candidate) {
  const auto sum = static_cast<Value>(candidate);
  return sum < value ? sum : value;
}

/// From each pixel of a row to the others, both ways: within 1, 3 and 7 px. Loops without
/// dependence on their own results, which the compiler vectorizes.
void spreadAlong(Value* row, int width) {
  PaddedRow padded_front;
  PaddedRow padded_back;
  padded_front.fill(kFarthest);
  padded_back.fill(kFarthest);
  Value* front = padded_front.data() + kPadding;
  Value* back = padded_back.data() + kPadding;
  std::copy_n(row, width, front);
  for (int x = 0; x < width; ++x)
    back[x] = least(least(front[x], front[x - 1] + kStraight), front[x + 1] + kStraight);
  for (int x = 0; x < width; ++x)
    front[x] = least(least(back[x], back[x - 2] + 2 * kStraight), back[x + 2] + 2 * kStraight);
  for (int x = 0; x < width; ++x)
    row[x] = least(least(front[x], front[x - 4] + 4 * kStraight), front[x + 4] + 4 * kStraight);
}

/// From the pixels of a row to those of the next one.
void spreadAcross(const Value* from, Value* row, int width) {
  for (int x = 0; x < width; ++x) row[x] = least(row[x], from[x] + kStraight);
  for (int x = 1; x < width; ++x) row[x] = least(row[x], from[x - 1] + kDiagonal);
  for (int x = 0; x + 1 < width; ++x) row[x] = least(row[x], from[x + 1] + kDiagonal);
}

}  // namespace

void distanceToDirection(const DirectedEdges& edges, int direction,
                         std::span<std::uint8_t> distance) {
  const std::array<std::uint8_t, 256> cost = costsFor(direction);
  const int width = edges.width;
  const int height = edges.height;
  const auto count = static_cast<std::size_t>(width * height);
  for (std::size_t i = 0; i < count; ++i) distance[i] = cost[edges.direction[i]];
  for (int y = 0; y < height; ++y) {
    Value* row = distance.data() + y * width;
    if (y > 0) spreadAcross(row - width, row, width);
    spreadAlong(row, width);
  }
  for (int y = height - 2; y >= 0; --y) {
    Value* row = distance.data() + y * width;
    spreadAcross(row + width, row, width);
    spreadAlong(row, width);
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
