// SPDX-License-Identifier: Apache-2.0
#include "core/search/search_candidates.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/base/random.h"

namespace boresight {
namespace {

SearchCandidate at(double x_px, double distance_px) {
  SearchCandidate made;
  made.slide_x_px = x_px;
  made.distance_px = distance_px;
  return made;
}

TEST(CandidateList, NearCandidates_AreOneTheBetter) {
  CandidateList list(40.0, 3.0);
  list.insert(at(0.0, 2.0));
  list.insert(at(2.0, 1.0));
  ASSERT_EQ(list.candidates().size(), 1u);
  EXPECT_EQ(list.candidates()[0].distance_px, 1.0);
  list.insert(at(1.0, 1.5));
  EXPECT_EQ(list.candidates().size(), 1u);
  list.insert(at(10.0, 3.0));
  EXPECT_EQ(list.candidates().size(), 2u);
}

TEST(CandidateList, TurnsByAFullTurnLess_AreNear) {
  CandidateList list(40.0, 3.0);
  SearchCandidate one = at(0.0, 1.0);
  one.roll_rad = kPi;
  SearchCandidate other = at(0.0, 2.0);
  other.roll_rad = -kPi;
  list.insert(one);
  list.insert(other);
  EXPECT_EQ(list.candidates().size(), 1u);
}

TEST(CandidateList, RandomCandidates_AreKeptInOrderAndApart) {
  Random random(7);
  CandidateList list(40.0, 3.0);
  double least = 1e9;
  for (int i = 0; i < 500; ++i) {
    const SearchCandidate made = at(random.uniform(-200.0, 200.0), random.uniform(0.0, 5.0));
    least = std::min(least, made.distance_px);
    const bool accepted = list.accepts(made.distance_px);
    list.insert(made);
    const auto kept = list.candidates();
    if (!accepted) {
      EXPECT_TRUE(std::none_of(kept.begin(), kept.end(),
                               [&](const auto& one) { return one.slide_x_px == made.slide_x_px; }));
    }
    for (std::size_t a = 0; a + 1 < kept.size(); ++a)
      EXPECT_LE(kept[a].distance_px, kept[a + 1].distance_px);
    for (std::size_t a = 0; a < kept.size(); ++a)
      for (std::size_t b = a + 1; b < kept.size(); ++b)
        EXPECT_GE(std::abs(kept[a].slide_x_px - kept[b].slide_x_px), 3.0);
  }
  EXPECT_EQ(list.candidates()[0].distance_px, least);
  EXPECT_EQ(list.candidates().size(), static_cast<std::size_t>(CandidateList::kCapacity));
}

}  // namespace
}  // namespace boresight
