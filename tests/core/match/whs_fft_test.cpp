// SPDX-License-Identifier: Apache-2.0
#include "tests/core/match/whs_fft.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/match/whs.h"
#include "tests/core/match/search_problem.h"

namespace boresight::test {
namespace {

constexpr int kMaskKinds = static_cast<int>(MaskKind::kCount);

TEST(WhsByFft, GivesTheSameIntegersAsTheCore) {
  Dice dice;
  for (int trial = 0; trial < 48; ++trial) {
    const int side = 2 * dice.between(4, trial % 8 == 0 ? 100 : 40);
    const auto problem =
        randomProblem(side, static_cast<MaskKind>(trial % kMaskKinds), 120, 120, dice);
    const SearchWindow& window = problem->window;
    std::vector<WhsCounts> map(static_cast<std::size_t>(window.width() * window.height()));
    whsScoreMap(problem->view, problem->test.image, window, map);
    ASSERT_EQ(map, whsMapByFft(problem->view, problem->test.image, window))
        << "trial " << trial << " side " << side;
  }
}

TEST(WhsByFft, HasItsLargestValueWhereEverySearchEnds) {
  Dice dice;
  std::vector<OwnedSearch> searches;
  searches.reserve(kKernelSets);  // a search points into its own memory
  for (const Kernels kernels : availableKernels()) searches.emplace_back(256, 300, kernels);
  for (int trial = 0; trial < 24; ++trial) {
    const int side = 2 * dice.between(4, 80);
    const auto problem =
        randomProblem(side, static_cast<MaskKind>(trial % kMaskKinds), 200, 150, dice);
    const SearchWindow& window = problem->window;
    const std::vector<WhsCounts> map = whsMapByFft(problem->view, problem->test.image, window);
    const WhsNorms norms = whsNormsReference(problem->view);
    std::int64_t largest = 0;
    for (const WhsCounts& counts : map) largest = std::max(largest, whsComparable(counts, norms));
    for (OwnedSearch& owned : searches) {
      const WhsPeak peak = run(owned.search, *problem);
      const int x = peak.x - window.x_min, y = peak.y - window.y_min;
      const WhsCounts& there = map[static_cast<std::size_t>(y * window.width() + x)];
      ASSERT_EQ(peak.counts, there) << "trial " << trial;
      ASSERT_EQ(whsComparable(peak.counts, norms), largest) << "trial " << trial;
    }
  }
}

}  // namespace
}  // namespace boresight::test
