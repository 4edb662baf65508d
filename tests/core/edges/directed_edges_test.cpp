// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/edges/direction_distance.h"

namespace boresight {
namespace {

/// A small image with all its memory.
struct Scene {
  Scene(int width, int height)
      : gray(static_cast<std::size_t>(width * height), 90),
        seen(gray.size(), 1),
        direction(gray.size()),
        block(1 << 20) {
    image.seen = seen;
    image.width = edges.width = width;
    image.height = edges.height = height;
    edges.direction = direction;
  }
  void detect() { detect(gray, 1); }
  /// Channels one after the other.
  void detect(std::vector<std::uint8_t> values, int channels) {
    Arena arena(block);
    DirectedEdgeDetector detector;
    detector.create(image.width, arena);
    image.value = values;
    detector.begin(image.width, image.height, channels, edges);
    while (!detector.step(image, 7, edges)) {
    }
  }

  std::vector<std::uint8_t> gray, seen, direction;
  std::vector<std::byte> block;
  SmallImage image;
  DirectedEdges edges;
};

TEST(DirectedEdges, DirectionOfANormal_IsTheNearestOfEight) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const int x = static_cast<int>(random.below(4001)) - 2000;
    const int y = static_cast<int>(random.below(4001)) - 2000;
    if (x * x + y * y < 1000) continue;
    const double steps = std::atan2(y, x) / (kPi / 8.0);
    if (std::abs(steps - std::floor(steps) - 0.5) < 0.02) continue;  // at a boundary
    const int expected = (static_cast<int>(std::floor(steps + 0.5)) + 16) % kEdgeDirections;
    EXPECT_EQ(edgeDirectionOf(x, y), expected) << x << " " << y;
    EXPECT_EQ(edgeDirectionOf(-x, -y), expected) << x << " " << y;
  }
}

TEST(DirectedEdges, StepAtAnyAngle_IsFoundOnTheLineWithItsDirection) {
  for (int degrees = 0; degrees < 180; degrees += 15) {
    SCOPED_TRACE(degrees);
    const double c = std::cos(degrees * kDegree_rad);
    const double s = std::sin(degrees * kDegree_rad);
    Scene scene(64, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double across = c * (x - 31.5) + s * (y - 31.5);
        scene.gray[static_cast<std::size_t>(64 * y + x)] =
            static_cast<std::uint8_t>(60.0 + 80.0 * std::clamp(across + 0.5, 0.0, 1.0));
      }
    scene.detect();
    int count = 0;
    for (int y = 4; y < 60; ++y)
      for (int x = 4; x < 60; ++x) {
        const std::uint8_t found = scene.edges.at(x, y);
        if (found == DirectedEdges::kNone) continue;
        ++count;
        EXPECT_LT(std::abs(c * (x - 31.5) + s * (y - 31.5)), 1.1);
        EXPECT_LE(directionsApart(found, edgeDirectionOf(static_cast<int>(1000.0 * c),
                                                         static_cast<int>(1000.0 * s))),
                  1);
      }
    EXPECT_GE(count, 50);
  }
}

TEST(DirectedEdges, SeveralChannels_ShowTheEdgesOfEach) {
  // A step across in the first channel, one down in the second, none in the third.
  Scene scene(64, 64);
  std::vector<std::uint8_t> channels(3 * 64 * 64, 90);
  for (std::size_t i = 0; i < 64 * 64; ++i) {
    if (i % 64 >= 32) channels[i] = 140;
    if (i / 64 >= 32) channels[64 * 64 + i] = 180;
  }
  scene.detect(channels, 3);
  const auto isEdge = [&](int x, int y, int direction) {
    for (int step = -1; step <= 1; ++step)
      if (scene.edges.at(direction == 0 ? x + step : x, direction == 0 ? y : y + step) == direction)
        return true;
    return false;
  };
  for (int i = 4; i < 28; ++i) {
    EXPECT_TRUE(isEdge(32, i, 0)) << i;
    EXPECT_TRUE(isEdge(i, 32, 4)) << i;
  }
}

TEST(DirectedEdges, EqualChannels_GiveTheEdgesOfOne) {
  Random random(9);
  Scene scene(48, 40);
  for (std::uint8_t& value : scene.gray) value = static_cast<std::uint8_t>(random.below(256));
  scene.detect();
  const std::vector<std::uint8_t> of_one = scene.direction;
  std::vector<std::uint8_t> channels;
  for (int i = 0; i < 3; ++i) channels.insert(channels.end(), scene.gray.begin(), scene.gray.end());
  scene.detect(channels, 3);
  EXPECT_EQ(scene.direction, of_one);
}

TEST(DirectedEdges, FlatImageAndUnseenPixels_HaveNone) {
  Scene scene(64, 64);
  scene.detect();
  EXPECT_EQ(scene.direction, std::vector<std::uint8_t>(64 * 64, DirectedEdges::kNone));
  for (int y = 0; y < 64; ++y)
    for (int x = 32; x < 64; ++x) {
      scene.gray[static_cast<std::size_t>(64 * y + x)] = 0;
      scene.seen[static_cast<std::size_t>(64 * y + x)] = 0;
    }
  scene.detect();
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      EXPECT_EQ(scene.edges.at(x, y), x < 32 ? DirectedEdges::kNone : DirectedEdges::kUnseen);
}

/// Steps of 10 along the axes and 14 diagonally.
int chamfer(int dx, int dy) {
  const int longer = std::max(std::abs(dx), std::abs(dy));
  const int shorter = std::min(std::abs(dx), std::abs(dy));
  return 10 * (longer - shorter) + 14 * shorter;
}

TEST(DirectionDistance, IsTheLeastOverAllEdgesByBruteForce) {
  Random random(3);
  constexpr int kWidth = 37, kHeight = 23;
  Scene scene(kWidth, kHeight);
  for (auto& direction : scene.direction)
    direction =
        random.below(40) == 0 ? static_cast<std::uint8_t>(random.below(8)) : DirectedEdges::kNone;
  std::vector<std::uint8_t> distance(scene.direction.size());
  for (int direction = 0; direction < kEdgeDirections; ++direction) {
    distanceToDirection(scene.edges, direction, distance);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        int least = kFarthest;
        for (int v = 0; v < kHeight; ++v)
          for (int u = 0; u < kWidth; ++u) {
            const std::uint8_t found = scene.edges.at(u, v);
            if (found == DirectedEdges::kNone) continue;
            least = std::min(least, chamfer(u - x, v - y) +
                                        kStepOfDirection * directionsApart(found, direction));
          }
        ASSERT_EQ(distance[static_cast<std::size_t>(y * kWidth + x)], least) << x << " " << y;
      }
  }
}

TEST(DirectionDistance, UnknownPixels_HaveTheMeanOfTheOthers) {
  Scene scene(20, 10);
  std::ranges::fill(scene.direction, DirectedEdges::kNone);
  scene.direction[25] = 0;
  for (std::size_t i = 100; i < 200; ++i) scene.direction[i] = DirectedEdges::kUnseen;
  std::vector<std::uint8_t> distance(200);
  distanceToDirection(scene.edges, 0, distance);
  const int sum = std::accumulate(distance.begin(), distance.begin() + 100, 0);
  for (std::size_t i = 100; i < 200; ++i) EXPECT_EQ(distance[i], sum / 100);
}

}  // namespace
}  // namespace boresight
