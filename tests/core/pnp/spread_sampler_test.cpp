// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/spread_sampler.h"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight {
namespace {

std::vector<Eigen::Vector2d> randomPlaces(Random& random, int count) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(100.0, 900.0);
    places.emplace_back(x, random.uniform(100.0, 900.0));
  }
  return places;
}

TEST(SpreadSampler, DrawsDistinctIndicesWithEqualFrequency) {
  // A regular polygon: every place is like every other, so spreading must favour none.
  std::vector<Eigen::Vector2d> places;
  constexpr int kPlaces = 12;
  for (int i = 0; i < kPlaces; ++i) {
    const double azimuth_rad = 2.0 * kPi * i / kPlaces;
    places.emplace_back(100.0 * cos(azimuth_rad), 100.0 * sin(azimuth_rad));
  }
  for (const int size : {3, 4}) {
    SpreadSampler sampler;
    sampler.begin(places, size, 5);
    std::vector<int> drawn(kPlaces, 0);
    constexpr int kDraws = 12000;
    for (int i = 0; i < kDraws; ++i) {
      const SpreadSampler::Sample sample = sampler.draw();
      const std::set<std::int32_t> distinct(sample.begin(), sample.begin() + size);
      ASSERT_EQ(distinct.size(), static_cast<std::size_t>(size));
      ASSERT_GE(*distinct.begin(), 0);
      ASSERT_LT(*distinct.rbegin(), kPlaces);
      for (const std::int32_t index : distinct) ++drawn[static_cast<std::size_t>(index)];
    }
    const double expected = static_cast<double>(kDraws) * size / kPlaces;
    for (const int count : drawn) EXPECT_NEAR(count, expected, 5.0 * std::sqrt(expected));
  }
}

TEST(SpreadSampler, AvoidsLinesAndSpots) {
  Random random = test::randomFor("SpreadSampler.AvoidsLinesAndSpots");
  std::vector<Eigen::Vector2d> places = randomPlaces(random, 20);
  for (int i = 0; i < 20; ++i) places.emplace_back(100.0 + 40.0 * i, 500.0);  // a line
  for (int i = 0; i < 20; ++i) places.emplace_back(500.0 + 0.1 * i, 300.0 - 0.2 * (i % 5));
  SpreadSampler sampler;
  sampler.begin(places, 4, 9);
  for (int draw = 0; draw < 5000; ++draw) {
    const SpreadSampler::Sample sample = sampler.draw();
    const auto among = [&sample](int first, int last) {
      return std::count_if(sample.begin(), sample.end(),
                           [=](std::int32_t i) { return i >= first && i < last; });
    };
    EXPECT_LT(among(20, 40), 4) << "all four on the line";
    EXPECT_LT(among(40, 60), 4) << "all four in the spot";
  }
}

TEST(SpreadSampler, CollinearPlaces_AreStillDrawn) {
  const std::vector<Eigen::Vector2d> same(5, Eigen::Vector2d(3.0, 4.0));
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < 5; ++i) line.emplace_back(i, 2.0 * i);
  for (const auto& places : {same, line}) {
    SpreadSampler sampler;
    sampler.begin(places, 4, 1);
    const SpreadSampler::Sample sample = sampler.draw();
    EXPECT_EQ(std::set<std::int32_t>(sample.begin(), sample.end()).size(), 4u);
  }
}

TEST(SpreadSampler, SamplesDependOnTheSeedOnly) {
  Random random = test::randomFor("SpreadSampler.TheSeedAloneDecides");
  const std::vector<Eigen::Vector2d> places = randomPlaces(random, 30);
  SpreadSampler first, second, other;
  first.begin(places, 4, 77);
  second.begin(places, 4, 77);
  other.begin(places, 4, 78);
  int equal = 0;
  for (int draw = 0; draw < 100; ++draw) {
    const auto sample = first.draw();
    ASSERT_EQ(sample, second.draw());
    equal += sample == other.draw() ? 1 : 0;
  }
  EXPECT_LT(equal, 5);
}

}  // namespace
}  // namespace boresight
