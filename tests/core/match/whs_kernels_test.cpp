// SPDX-License-Identifier: Apache-2.0
// Every set of kernels that this machine has finds what the definition says.
#include <algorithm>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "core/base/kernels.h"
#include "core/match/whs.h"
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

constexpr int kMaskKinds = static_cast<int>(MaskKind::kCount);

class WhsKernels : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (kernelsAvailable(kernels_)) return;
    std::cout << "not available here: " << kernelsName(kernels_) << "\n";
    GTEST_SKIP() << kernelsName(kernels_) << " is not available here";
  }
  const Kernels kernels_ = static_cast<Kernels>(GetParam());
};

TEST_P(WhsKernels, EqualTheDefinitionForRandomInput) {
  Dice dice;
  OwnedSearch owned(64, 300, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
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
  Dice dice;
  OwnedSearch owned(512, 8, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int side = 2; side <= 512; side += side < 260 ? 2 : 14) {
    const MaskKind kind = static_cast<MaskKind>(side / 2 % kMaskKinds);
    const auto problem = randomProblem(side, kind, 3, 3, dice);
    SCOPED_TRACE(testing::Message() << "side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
  }
}

TEST_P(WhsKernels, EqualTheDefinitionAroundWordsAndRegisters) {
  // Widths about the columns of a tile, heights about the rows of a register and of a band.
  Dice dice;
  OwnedSearch owned(64, 300, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
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

TEST_P(WhsKernels, EqualTheDefinitionWhereAllIsTied) {
  Dice dice;
  OwnedSearch owned(64, 300, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
  for (const double template_density : {0.0, 1.0}) {
    for (const double test_density : {0.0, 1.0}) {
      for (int kind = 0; kind < kMaskKinds; ++kind) {
        Problem problem(noise(32, 32, template_density, dice),
                        makeMask(32, 32, static_cast<MaskKind>(kind), 32, dice),
                        noise(32 + dice.below(90), 32 + dice.below(90), test_density, dice), 32);
        problem.predicted_x = dice.between(0, 120);
        problem.predicted_y = dice.between(0, 120);
        problem.exclusion_px = dice.below(9);
        ASSERT_EQ(run(owned.search, problem), reference(problem))
            << template_density << " " << test_density << " mask " << kind;
      }
    }
  }
}

TEST_P(WhsKernels, EqualTheDefinitionForTheLargestCounts) {
  // A full mask of 256 x 256 over nothing but test edges counts 2^16 of them.
  Dice dice;
  OwnedSearch owned(256, 300, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
  for (const double density : {0.0, 0.01, 0.08}) {
    for (const double test_density : {1.0, 0.999}) {
      Problem problem(noise(256, 256, density, dice),
                      makeMask(256, 256, MaskKind::kFull, 256, dice),
                      noise(330, 275, test_density, dice), 256);
      problem.exclusion_px = 6;
      ASSERT_EQ(run(owned.search, problem), peakOfMap(problem)) << density << " " << test_density;
    }
  }
}

TEST_P(WhsKernels, EqualTheMapOfCountsForWideWindows) {
  Dice dice;
  OwnedSearch owned(512, 1400, kernels_);
  ASSERT_EQ(owned.status, Status::kOk);
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

TEST_P(WhsKernels, SearchesInTurnAsAFreshOneWould) {
  // What one search leaves behind must not reach the next, whatever their sizes.
  Dice dice;
  OwnedSearch owned(256, 300, kernels_);
  for (int trial = 0; trial < 60; ++trial) {
    const int side = 2 * dice.between(4, trial % 4 == 0 ? 128 : 40);
    const auto problem =
        randomProblem(side, static_cast<MaskKind>(dice.below(kMaskKinds)), 40, 40, dice);
    OwnedSearch fresh(256, 300, kernels_);
    ASSERT_EQ(run(owned.search, *problem), run(fresh.search, *problem)) << trial;
    ASSERT_EQ(owned.search.peak(), peakOfMap(*problem)) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, WhsKernels, testing::Range(0, kKernelSets),
                         [](const testing::TestParamInfo<int>& set) {
                           return std::string(kernelsName(static_cast<Kernels>(set.param)));
                         });

}  // namespace
}  // namespace boresight
