// SPDX-License-Identifier: Apache-2.0
#include "core/edges/direction_distance.h"

#include <algorithm>
#include <array>

namespace boresight {
namespace {

constexpr int kStraight = 10;
constexpr int kDiagonal = 14;

using Value = std::uint8_t;
constexpr int kPadding = 8;  ///< px on both sides of a row, beyond the largest distance
using PaddedRow = std::array<Value, DirectedEdgeDetector::kMaxWidth + 2 * kPadding>;
static_assert(kPadding * kStraight > kFarthest && kFarthest + 4 * kStraight < 256);

/// Cost of an edge of a direction, and of no edge: kNone and kUnseen are far from all directions.
/// Without branches, so that many pixels are computed at once.
Value costOf(Value edge_direction, Value direction) {
  constexpr Value kMostApart = kEdgeDirections / 2;
  static_assert(kStepOfDirection * kMostApart == kFarthest);
  static_assert(DirectedEdges::kUnseen > 2 * kEdgeDirections);
  const auto ahead = static_cast<Value>(edge_direction - direction);
  const auto behind = static_cast<Value>(direction - edge_direction);
  const Value apart = edge_direction < direction ? behind : ahead;
  const auto around = static_cast<Value>(kEdgeDirections - apart);
  const Value shorter = apart < around ? apart : around;
  return static_cast<Value>(kStepOfDirection * (shorter < kMostApart ? shorter : kMostApart));
}

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

bool hasUnseen(std::span<const std::uint8_t> directions) {
  unsigned unseen = 0;
  for (const std::uint8_t direction : directions)
    unseen |= direction == DirectedEdges::kUnseen ? 1 : 0;
  return unseen != 0;
}

/// Unknown pixels are given the mean of the known ones.
void fillUnseen(const DirectedEdges& edges, std::span<std::uint8_t> distance) {
  const auto count = static_cast<std::size_t>(edges.width * edges.height);
  const std::span<const std::uint8_t> directions = edges.direction.first(count);
  if (!hasUnseen(directions)) return;
  std::uint64_t sum = 0;
  std::uint64_t known = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t is_known = directions[i] == DirectedEdges::kUnseen ? 0 : 1;
    sum += is_known * distance[i];
    known += is_known;
  }
  const auto mean = static_cast<std::uint8_t>(known > 0 ? sum / known : kFarthest);
  for (std::size_t i = 0; i < count; ++i)
    if (directions[i] == DirectedEdges::kUnseen) distance[i] = mean;
}

}  // namespace

void distanceToDirection(const DirectedEdges& edges, int direction,
                         std::span<std::uint8_t> distance) {
  const int width = edges.width;
  const int height = edges.height;
  const auto count = static_cast<std::size_t>(width * height);
  const std::uint8_t* edge_direction = edges.direction.data();
  Value* initial = distance.data();
  const auto towards = static_cast<Value>(direction);
  for (std::size_t i = 0; i < count; ++i) initial[i] = costOf(edge_direction[i], towards);
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
  fillUnseen(edges, distance);
}

}  // namespace boresight
