// SPDX-License-Identifier: Apache-2.0
#include "core/search/slide_sums.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/search/compass_search.h"
#include "tests/core/search/search_scene.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

/// Random edges, their maps, and what the sums are computed from.
struct Maps {
  Maps(int width, int height, int slide_x, int slide_y, Random& random)
      : direction(static_cast<std::size_t>(width * height), DirectedEdges::kNone), block(1 << 20) {
    for (std::uint8_t& pixel : direction)
      if (random.below(12) == 0) pixel = static_cast<std::uint8_t>(random.below(kEdgeDirections));
    edges.direction = direction;
    edges.width = width;
    edges.height = height;
    Arena arena(block);
    sums.create(arena);
    sums.begin(width, height, slide_x, slide_y);
    for (int i = 0; i < kEdgeDirections; ++i) {
      sums.takeMap(edges, i);
      std::vector<std::uint8_t>& steps = distance[i];
      steps.resize(direction.size());
      distanceToDirection(edges, i, steps);
      long sum = 0;
      for (std::uint8_t& step : steps) {
        step = static_cast<std::uint8_t>(std::floor(step * kDistanceUnit_px / 0.4 + 0.5 + 1e-9));
        sum += step;
      }
      mean[i] = static_cast<int>(
          std::floor(static_cast<double>(sum) / static_cast<double>(steps.size()) + 0.5));
    }
  }
  int at(int of_direction, int x, int y) const {
    if (x < 0 || y < 0 || x >= edges.width || y >= edges.height) return mean[of_direction];
    return distance[of_direction][static_cast<std::size_t>(y * edges.width + x)];
  }

  std::vector<std::uint8_t> direction;
  std::vector<std::byte> block;
  DirectedEdges edges;
  SlideSums sums;
  std::vector<std::uint8_t> distance[kEdgeDirections];
  int mean[kEdgeDirections] = {};
};

TEST(SlideSums, RandomPlaces_HaveThePlainSums) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const bool largest = round == 0;
    const int side = SlideSums::kMaxView_px;
    const int width = largest ? side : 30 + static_cast<int>(random.below(90));
    const int height = largest ? side : 30 + static_cast<int>(random.below(90));
    const int slide_x = largest ? side / 2 : static_cast<int>(random.below(15));
    const int slide_y = largest ? side / 2 : static_cast<int>(random.below(15));
    Maps maps(width, height, slide_x, slide_y, random);
    std::vector<SlideSums::Place> places(1 + random.below(SlideSums::kMaxPlaces));
    for (SlideSums::Place& place : places) {
      // Some of them leave the view by less than the border is wide.
      const int reach_x = largest ? 10 : width;
      const int reach_y = largest ? 10 : height;
      place.x = static_cast<std::int16_t>(static_cast<int>(random.below(reach_x)) - reach_x / 2);
      place.y = static_cast<std::int16_t>(static_cast<int>(random.below(reach_y)) - reach_y / 2);
      place.direction = static_cast<std::uint8_t>(random.below(kEdgeDirections));
    }
    maps.sums.add(places);
    ASSERT_EQ(maps.sums.columns(), 2 * slide_x + 1);
    ASSERT_EQ(maps.sums.rows(), 2 * slide_y + 1);
    int least = 1 << 20;
    for (int row = 0; row < maps.sums.rows(); ++row)
      for (int column = 0; column < maps.sums.columns(); ++column) {
        int sum = 0;
        for (const SlideSums::Place& place : places)
          sum += maps.at(place.direction, width / 2 + place.x + column - slide_x,
                         height / 2 + place.y + row - slide_y);
        ASSERT_EQ(maps.sums.sum(column, row), sum) << column << " " << row;
        least = std::min(least, sum);
      }
    EXPECT_EQ(maps.sums.least(), least);
  }
}

TEST(SlideSums, PlacesFarOutsideTheView_CountAsTheMean) {
  Random random(2);
  Maps maps(60, 50, 5, 5, random);
  const SlideSums::Place places[] = {{3000, 0, 1}, {-3000, 3000, 1}, {0, -3000, 1}};
  maps.sums.add(places);
  EXPECT_EQ(maps.sums.sum(0, 0), 3 * maps.mean[1]);
  EXPECT_EQ(maps.sums.sum(10, 10), 3 * maps.mean[1]);
  EXPECT_EQ(maps.sums.at(1, 1e6, -1e6), maps.mean[1]);
}

TEST(SlideSums, DistanceOfAPlace_IsThatOfItsPixel) {
  Random random(3);
  Maps maps(61, 51, 5, 5, random);
  for (int i = 0; i < 500; ++i) {
    const int direction = static_cast<int>(random.below(kEdgeDirections));
    const int x = static_cast<int>(random.below(61));
    const int y = static_cast<int>(random.below(51));
    EXPECT_EQ(maps.sums.at(direction, x - 30 + random.uniform(-0.49, 0.49),
                           y - 25 + random.uniform(-0.49, 0.49)),
              maps.at(direction, x, y));
  }
}

/// Edges of the render at the truth; the descent starts from renders of nearby poses.
TEST(CompassSearch, GridPosesAroundTheTruth_ConvergeToTheTruth) {
  const test::Solid solid = test::stationMesh();
  const Camera camera = test::makePinhole(101, 101, 130.0);
  const Pose truth = test::truthPose();
  const test::Rendering seen = test::renderEdges(solid, camera, truth);
  std::vector<std::uint8_t> direction = test::directionsOf(seen.edges, 101, 101);
  DirectedEdges edges;
  edges.direction = direction;
  edges.width = edges.height = 101;
  std::vector<std::byte> block(1 << 20);
  Arena arena(block);
  SlideSums maps;
  maps.create(arena);
  maps.begin(101, 101, 3, 3);
  for (int i = 0; i < kEdgeDirections; ++i) maps.takeMap(edges, i);

  const Eigen::Vector3d middle_m = matchedBounds(solid.view()).centre();
  const Eigen::Vector3d pivot_m = truth * middle_m;
  Random random(1);
  double sum_before_px = 0.0;
  double sum_after_px = 0.0;
  for (int i = 0; i < 20; ++i) {
    Vector6d offset;
    offset.head<3>() = test::randomVector(random, 6.0 * kDegree_rad);
    offset.tail<3>() =
        pivot_m.z() *
        test::randomVector(random, 1.0).cwiseQuotient(Eigen::Vector3d(camera.fx, camera.fx, 25.0));
    Pose pose = displacedAboutPivot(truth, offset, pivot_m);
    const test::Rendering render = test::renderEdges(solid, camera, pose);
    CompassSearch search;
    ASSERT_TRUE(search.takePlaces(solid.view(), render.edges));
    sum_before_px += test::meanDisplacement_px(solid, camera, truth, pose);
    const double distance_px = search.descend(maps, middle_m, pose);
    EXPECT_LT(distance_px, 1.2);
    const double error_px = test::meanDisplacement_px(solid, camera, truth, pose);
    EXPECT_LT(error_px, 1.5);
    sum_after_px += error_px;
  }
  EXPECT_LT(sum_after_px, 0.5 * sum_before_px);
}

}  // namespace
}  // namespace boresight
