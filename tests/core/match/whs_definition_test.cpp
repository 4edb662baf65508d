// SPDX-License-Identifier: Apache-2.0
#include "core/match/whs.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/core/match/search_problem.h"

namespace boresight {
namespace {

using test::Dice;
using test::makeMask;
using test::MaskKind;
using test::noise;
using test::OwnedSearch;
using test::peakOfMap;
using test::Problem;
using test::randomProblem;
using test::reference;
using test::run;

TEST(WhsSearch, EqualsTheDefinitionForRandomInput) {
  Dice dice;
  OwnedSearch owned(64, 300);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int trial = 0; trial < 600; ++trial) {
    const int side = 2 * dice.between(4, 20);
    const MaskKind kind = static_cast<MaskKind>(trial % static_cast<int>(MaskKind::kCount));
    const auto problem = randomProblem(side, kind, 60, 60, dice);
    SCOPED_TRACE(testing::Message()
                 << "trial " << trial << " side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
    ASSERT_EQ(owned.search.norms(), whsNormsReference(problem->view));
  }
}

TEST(WhsSearch, EqualsTheDefinitionForEverySide) {
  Dice dice;
  OwnedSearch owned(512, 8);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int side = 8; side <= 512; side += 2) {
    const MaskKind kind = static_cast<MaskKind>(side / 2 % static_cast<int>(MaskKind::kCount));
    const auto problem = randomProblem(side, kind, 3, 3, dice);
    SCOPED_TRACE(testing::Message() << "side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
  }
}

TEST(WhsSearch, EqualsTheMapOfCountsForWideWindows) {
  // Several tiles of columns and bands of rows, and the last words of each in all lengths.
  Dice dice;
  OwnedSearch owned(512, 1400);
  ASSERT_EQ(owned.status, Status::kOk);
  int trial = 0;
  for (const int side : {8, 16, 32, 62, 64, 66, 128, 200, 256, 512}) {
    for (int repetition = 0; repetition < 4; ++repetition, ++trial) {
      const MaskKind kind = static_cast<MaskKind>(trial % static_cast<int>(MaskKind::kCount));
      const bool wide = repetition % 2 == 0;
      const int budget = 400000000 / (side * side + 6000);
      const int most_x = wide ? 1400 : 90;
      const auto problem =
          randomProblem(side, kind, most_x, std::clamp(budget / most_x, 3, 1400), dice);
      problem->exclusion_px = dice.below(60);
      SCOPED_TRACE(testing::Message()
                   << "side " << side << " mask " << static_cast<int>(kind) << " window "
                   << problem->window.width() << " x " << problem->window.height());
      ASSERT_EQ(run(owned.search, *problem), peakOfMap(*problem));
    }
  }
}

TEST(WhsSearch, ListsTemplatesWithMorePixelsThanFitSomeRowsAtATime) {
  Dice dice;
  OwnedSearch owned(512, 200);
  ASSERT_EQ(owned.status, Status::kOk);
  for (const MaskKind kind : {MaskKind::kFull, MaskKind::kNoise, MaskKind::kRowStripes}) {
    const int side = 512;
    const Problem problem(noise(side, side, 0.9, dice), makeMask(side, side, kind, side, dice),
                          noise(side + 130, side + 40, 0.5, dice), side);
    ASSERT_GT(whsNorms(problem.view).edges, 3 * 6144);
    ASSERT_EQ(run(owned.search, problem), peakOfMap(problem));
  }
}

}  // namespace
}  // namespace boresight
