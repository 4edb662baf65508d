// SPDX-License-Identifier: Apache-2.0
#include "core/match/whs.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/kernels.h"
#include "tests/core/match/search_problem.h"

namespace boresight::test {
namespace {

TEST(WhsSearch, BreaksTiesByDistanceThenRasterOrder) {
  Dice dice;
  OwnedSearch owned(64, 300);
  for (int trial = 0; trial < 200; ++trial) {
    // Edges and test edges of small period: most scores occur many times.
    const int period_x = dice.between(1, 9), period_y = dice.between(1, 9);
    const int side = 2 * dice.between(4, 16);
    const OwnedBits cell = noise(period_x, period_y, dice.uniform(0.0, 1.0), dice);
    const auto tiled = [&](int width, int height) {
      return drawn(width, height,
                   [&](int x, int y) { return cell.image.get(x % period_x, y % period_y); });
    };
    const MaskKind kind = trial % 2 == 0 ? MaskKind::kFull : MaskKind::kCircle;
    Problem problem(tiled(side, side), makeMask(side, side, kind, side, dice),
                    tiled(side + dice.below(80), side + dice.below(80)), side);
    problem.predicted_x = dice.between(0, 100);
    problem.predicted_y = dice.between(0, 100);
    problem.exclusion_px = dice.below(12);
    ASSERT_EQ(run(owned.search, problem), reference(problem)) << "trial " << trial;
  }
}

TEST(WhsSearch, HasNoSecondWhenTheExclusionCoversTheWindow) {
  Dice dice;
  OwnedSearch owned(32, 300);
  Problem problem(noise(32, 32, 0.1, dice), fullMask(32), noise(90, 95, 0.1, dice), 32);
  problem.exclusion_px = 100;
  EXPECT_FALSE(run(owned.search, problem).has_second);
  EXPECT_EQ(owned.search.peak(), reference(problem));
  problem.exclusion_px = std::numeric_limits<int>::max();
  EXPECT_FALSE(run(owned.search, problem).has_second);
  problem.exclusion_px = 20;
  const WhsPeak peak = run(owned.search, problem);
  EXPECT_TRUE(peak.has_second);
  EXPECT_EQ(peak, reference(problem));
}

TEST(WhsSearch, FindsACopyInTheLastColumnsOfEveryWidth) {
  // Where a word, a register or a tile ends, counters must not lose pixels.
  Dice dice;
  OwnedSearch owned(16, 1400);
  constexpr int kSide = 16;
  const auto search = [&](int offsets, int from_last) {
    const OwnedBits edges = noise(kSide, kSide, 0.2, dice);
    const int left = offsets - 1 - from_last, top = 1;
    const auto isCopied = [&](int x, int y) {
      const bool inside = x >= left && x < left + kSide && y >= top && y < top + kSide;
      return inside && edges.image.get(x - left, y - top);
    };
    const Problem problem(edges, fullMask(kSide), drawn(offsets + kSide - 1, kSide + 2, isCopied),
                          kSide);
    const WhsPeak peak = run(owned.search, problem);
    EXPECT_EQ(peak.x, problem.window.x_max - from_last) << offsets << " offsets";
    EXPECT_EQ(peak.y, problem.window.y_min + 1);
    EXPECT_EQ(whsScore(peak.counts, owned.search.norms()), 2.0);
  };
  for (int offsets = 8; offsets < 1400; offsets += offsets < 280 || offsets > 620 ? 1 : 13) {
    search(offsets, dice.below(8));
  }
}

TEST(WhsSearch, InterleavedOrAbandonedSearches_TakeBoundedStepsWithTheSameResults) {
  Dice dice;
  OwnedSearch first(256, 700), second(256, 700);
  const OwnedBits edges = noise(256, 256, 0.03, dice);
  const OwnedBits mask = fullMask(256);
  const Problem first_problem(edges, mask, noise(900, 800, 0.06, dice), 256);
  const Problem second_problem(edges, mask, noise(869, 817, 0.06, dice), 256);
  const WhsPeak first_whole = run(first.search, first_problem);
  const WhsPeak second_whole = run(second.search, second_problem);
  ASSERT_EQ(beginOn(first.search, first_problem), Status::kOk);
  ASSERT_EQ(beginOn(second.search, second_problem), Status::kOk);
  int steps = 0;
  for (bool first_done = false, second_done = false; !first_done || !second_done; ++steps) {
    if (!first_done) first_done = first.search.step();
    if (!second_done) second_done = second.search.step();
  }
  EXPECT_GT(steps, 4);
  EXPECT_EQ(first.search.peak(), first_whole);
  EXPECT_EQ(second.search.peak(), second_whole);

  ASSERT_EQ(beginOn(first.search, first_problem), Status::kOk);
  ASSERT_FALSE(first.search.step());
  const auto next = randomProblem(20, MaskKind::kFull, 60, 60, dice);
  EXPECT_EQ(run(first.search, *next), reference(*next)) << "begun before the end of another one";
}

TEST(WhsSearch, InvalidTemplatesAndWindows_AreRefused) {
  Dice dice;
  OwnedSearch owned(64, 100);
  Problem problem(noise(128, 128, 0.1, dice), fullMask(128), noise(300, 300, 0.1, dice), 64);
  problem.moveTemplate(64, 64);
  problem.window = {100, 100, 150, 150};
  EXPECT_EQ(beginOn(owned.search, problem), Status::kOk);
  const TemplateView view = problem.view;
  const SearchWindow window = problem.window;
  const auto expectStatus = [&](Status expected, auto change) {
    change();
    EXPECT_EQ(beginOn(owned.search, problem), expected);
    EXPECT_TRUE(owned.search.step() || expected == Status::kOk);
    problem.view = view;
    problem.window = window;
    problem.exclusion_px = 0;
  };
  const Status invalid = Status::kInvalidOption;
  expectStatus(invalid, [&] { problem.view.edges = nullptr; });
  expectStatus(invalid, [&] { problem.view.mask = nullptr; });
  for (const int side_px : {63, 0, 514})
    expectStatus(invalid, [&] { problem.view.side_px = side_px; });
  expectStatus(invalid, [&] { problem.view.center_x = 31; });
  expectStatus(invalid, [&] { problem.view.center_y = 97; });
  expectStatus(invalid, [&] { problem.window = SearchWindow{}; });
  expectStatus(invalid, [&] { problem.window.x_min = 31; });
  expectStatus(invalid, [&] { problem.window.y_max = 269; });
  expectStatus(invalid, [&] { problem.exclusion_px = -1; });
  expectStatus(Status::kCapacityExceeded, [&] { problem.window.x_max = 200; });
  expectStatus(Status::kCapacityExceeded, [&] { problem.window.y_max = 200; });
  expectStatus(Status::kOk, [&] { problem.window.x_max = problem.window.y_max = 199; });
  expectStatus(Status::kCapacityExceeded, [&] { problem.view.side_px = 66; });
  expectStatus(Status::kOk, [] {});
  WhsSearch fresh;
  EXPECT_TRUE(fresh.step());
}

TEST(WhsSearch, Memory_IsSmallAndAShortArenaIsReported) {
  Arena count;
  WhsSearch search;
  ASSERT_EQ(search.create(512, 1400, Kernels::kPortable, count), Status::kOk);
  EXPECT_LT(count.highWater(), 400000u);
  std::vector<std::byte> memory(count.highWater() - 1);
  Arena arena{memory};
  EXPECT_EQ(search.create(512, 1400, Kernels::kPortable, arena), Status::kArenaTooSmall);
  Arena other;
  EXPECT_EQ(search.create(514, 1400, Kernels::kPortable, other), Status::kInvalidOption);
  EXPECT_EQ(search.create(0, 1400, Kernels::kPortable, other), Status::kInvalidOption);
  EXPECT_EQ(search.create(512, 0, Kernels::kPortable, other), Status::kInvalidOption);
  for (int k = 0; k <= kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    EXPECT_EQ(search.create(512, 1400, kernels, other),
              kernelsAvailable(kernels) ? Status::kOk : Status::kInvalidOption);
  }
}

TEST(WhsSearch, ExtremeTemplatesAndMasks_AreSearchedAsByDefinition) {
  Dice dice;
  OwnedSearch owned(512, 200);
  for (const MaskKind kind : {MaskKind::kFull, MaskKind::kNoise, MaskKind::kRowStripes}) {
    const int side = 512;
    const Problem problem(noise(side, side, 0.9, dice), makeMask(side, side, kind, side, dice),
                          noise(side + 130, side + 40, 0.5, dice), side);
    ASSERT_GT(whsNorms(problem.view).edges, 3 * 6144) << "above the capacity of the list";
    ASSERT_EQ(run(owned.search, problem), peakOfMap(problem));
  }
  // Bars of a pixel's height, whose 510 upper and lower sides have the 1020 ends that are listed.
  const auto inBar = [](int x, int y) { return y % 2 == 0 && x >= 100 && x < 110; };
  for (const int side : {508, 510, 512}) {
    const Problem problem(noise(side, side, 0.3, dice), drawn(side, side, inBar),
                          noise(side + 9, side + 9, 0.3, dice), side);
    ASSERT_EQ(run(owned.search, problem), peakOfMap(problem)) << side;
  }
  const auto inEvenRow = [](int, int y) { return y % 2 == 0; };
  // Rows of mask on rows of test edges: from one offset to the next all or nothing is covered.
  for (const int side : {64, 254, 258, 300, 512}) {
    Problem problem(noise(side, side, 0.02, dice), drawn(side, side, inEvenRow),
                    drawn(side + 70, side + 9, inEvenRow), side);
    problem.exclusion_px = 1;
    for (const int row : {2, 3}) {  // bare and hidden offsets score the same: the nearest is best
      problem.predicted_y = problem.window.y_min + row;
      ASSERT_EQ(run(owned.search, problem), peakOfMap(problem)) << "side " << side;
    }
  }
}

// Every available set of kernels equals the definition.

constexpr int kMaskKinds = static_cast<int>(MaskKind::kCount);

class WhsKernels : public testing::TestWithParam<Kernels> {
 protected:
  const Kernels kernels_ = GetParam();
  Dice dice;
};

TEST_P(WhsKernels, EqualTheDefinitionForRandomInput) {
  OwnedSearch owned(64, 300, kernels_);
  for (int trial = 0; trial < 600; ++trial) {
    const int side = 2 * dice.between(1, 20);
    const MaskKind kind = static_cast<MaskKind>(trial % kMaskKinds);
    const auto problem = randomProblem(side, kind, 60, 60, dice);
    SCOPED_TRACE(testing::Message()
                 << "trial " << trial << " side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
    ASSERT_EQ(owned.search.norms(), whsNormsReference(problem->view));
  }
}

TEST_P(WhsKernels, EqualTheDefinitionForEverySide) {
  OwnedSearch owned(512, 8, kernels_);
  for (int side = 2; side <= 512; side += side < 260 ? 2 : 14) {
    const MaskKind kind = static_cast<MaskKind>(side / 2 % kMaskKinds);
    const auto problem = randomProblem(side, kind, 3, 3, dice);
    SCOPED_TRACE(testing::Message() << "side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
  }
}

TEST_P(WhsKernels, EqualTheDefinitionAroundWordsAndRegisters) {
  // Widths about the columns of a tile, heights about the rows of a register and of a band.
  OwnedSearch owned(64, 300, kernels_);
  int trial = 0;
  for (const int width : {1, 2, 7, 8, 9, 63, 64, 65, 127, 128, 129}) {
    for (const int height : {1, 2, 3, 4, 5, 7, 8, 9, 16, 127, 128, 129, 136}) {
      const int side = 2 * dice.between(4, 32), left = dice.below(130);
      const MaskKind kind = static_cast<MaskKind>(trial++ % kMaskKinds);
      Problem problem(noise(side, side, 0.1, dice), makeMask(side, side, kind, side, dice),
                      noise(left + width + side, height + side, 0.1, dice), side);
      problem.window = {left + side / 2, side / 2, left + side / 2 + width - 1,
                        side / 2 + height - 1};
      problem.exclusion_px = dice.below(9);
      SCOPED_TRACE(testing::Message() << width << " x " << height << " from " << left << " side "
                                      << side << " mask " << static_cast<int>(kind));
      ASSERT_EQ(run(owned.search, problem), peakOfMap(problem));
    }
  }
}

TEST_P(WhsKernels, EqualTheDefinitionForEqualScores) {
  OwnedSearch owned(64, 300, kernels_);
  for (const double template_density : {0.0, 1.0}) {
    for (const double test_density : {0.0, 1.0}) {
      for (int kind = 0; kind < kMaskKinds; ++kind) {
        Problem problem(noise(32, 32, template_density, dice),
                        makeMask(32, 32, static_cast<MaskKind>(kind), 32, dice),
                        noise(32 + dice.below(90), 32 + dice.below(90), test_density, dice), 32);
        problem.predicted_x = dice.between(0, 120);
        problem.predicted_y = dice.between(0, 120);
        problem.exclusion_px = dice.below(9);
        const WhsPeak peak = run(owned.search, problem);
        ASSERT_EQ(peak, reference(problem))
            << template_density << " " << test_density << " mask " << kind;
        // Every offset has the same score: the nearest to the predicted one is best.
        const SearchWindow& window = problem.window;
        ASSERT_EQ(peak.x, std::clamp(problem.predicted_x, window.x_min, window.x_max));
        ASSERT_EQ(peak.y, std::clamp(problem.predicted_y, window.y_min, window.y_max));
      }
    }
  }
}

TEST_P(WhsKernels, EqualTheDefinitionForTheLargestCounts) {
  // A full mask of 256 x 256 over nothing but test edges counts 2^16 of them.
  OwnedSearch owned(256, 300, kernels_);
  for (const double density : {0.0, 0.01, 0.08}) {
    for (const double test_density : {1.0, 0.999}) {
      Problem problem(noise(256, 256, density, dice), fullMask(256),
                      noise(330, 275, test_density, dice), 256);
      problem.exclusion_px = 6;
      ASSERT_EQ(run(owned.search, problem), peakOfMap(problem)) << density << " " << test_density;
    }
  }
}

TEST_P(WhsKernels, EqualTheMapOfCountsForWideWindows) {
  OwnedSearch owned(512, 1400, kernels_);
  int trial = 0;
  for (const int side : {8, 16, 32, 62, 64, 66, 128, 200, 256, 512}) {
    for (int repetition = 0; repetition < 3; ++repetition, ++trial) {
      const MaskKind kind = static_cast<MaskKind>(trial % kMaskKinds);
      const int budget = 200000000 / (side * side + 6000);
      const int most_x = repetition % 2 == 0 ? 700 : 90;
      const auto problem =
          randomProblem(side, kind, most_x, std::clamp(budget / most_x, 3, 700), dice);
      problem->exclusion_px = dice.below(60);
      SCOPED_TRACE(testing::Message()
                   << "side " << side << " mask " << static_cast<int>(kind) << " window "
                   << problem->window.width() << " x " << problem->window.height());
      ASSERT_EQ(run(owned.search, *problem), peakOfMap(*problem));
    }
  }
}

TEST_P(WhsKernels, ReusedSearch_EqualsTheMapOfCounts) {
  // The state of one search must not affect the next, for any sizes.
  OwnedSearch owned(256, 300, kernels_);
  for (int trial = 0; trial < 60; ++trial) {
    const int side = 2 * dice.between(4, trial % 4 == 0 ? 128 : 40);
    const auto problem =
        randomProblem(side, static_cast<MaskKind>(dice.below(kMaskKinds)), 40, 40, dice);
    ASSERT_EQ(run(owned.search, *problem), peakOfMap(*problem)) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, WhsKernels, testing::ValuesIn(availableKernels()), nameOfKernels);

}  // namespace
}  // namespace boresight::test
