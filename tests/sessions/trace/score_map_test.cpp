// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/score_map.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

using test::exampleTrace;

/// S+ and S- pixel by pixel.
WhsCounts countsByHand(const IterationTrace& iteration, const BitImage& test, const Template& item,
                       int x, int y) {
  const BitImage edges = iteration.render.edges.view();
  const BitImage mask = iteration.render.mask.view();
  const int half = iteration.template_side_px / 2;
  WhsCounts counts;
  for (int v = -half; v < half; ++v) {
    for (int u = -half; u < half; ++u) {
      if (!mask.get(item.center_x + u, item.center_y + v)) continue;
      const bool rendered = edges.get(item.center_x + u, item.center_y + v);
      const bool seen = test.get(x + u, y + v);
      if (rendered && seen) ++counts.edge_hits;
      if (!rendered && !seen) ++counts.empty_hits;
    }
  }
  return counts;
}

TEST(ScoreMap, HoldsItsPeakWhereTheSearchFoundIt) {
  int looked_at = 0;
  const IterationTrace& iteration = *exampleTrace().iterations.front();
  for (int i = 0; i < iteration.template_count; i += 7) {
    const auto map = scoreMap(*exampleTrace().edges, iteration, i);
    const Match& match = iteration.matches[static_cast<std::size_t>(i)];
    ASSERT_EQ(map.has_value(), match.searched);
    if (!map) continue;
    ++looked_at;
    EXPECT_EQ(map->countsAt(match.peak.x, match.peak.y), match.peak.counts);
    EXPECT_EQ(map->highest, map->scoreAt(match.peak.x, match.peak.y));
    if (match.peak.has_second) {
      EXPECT_EQ(map->countsAt(match.peak.second_x, match.peak.second_y), match.peak.second_counts);
    }
    EXPECT_LE(map->lowest, map->highest);
  }
  EXPECT_GT(looked_at, 3);
}

TEST(ScoreMap, IsWhatCountingPixelByPixelGives) {
  const IterationTrace& iteration = *exampleTrace().iterations.front();
  const BitImage test =
      exampleTrace().edges->level[static_cast<std::size_t>(iteration.level)].view();
  const auto map = scoreMap(*exampleTrace().edges, iteration, 3);
  ASSERT_TRUE(map);
  const SearchWindow& window = map->window;
  const Template& item = iteration.templates[3];
  for (int y = window.y_min; y <= window.y_max; y += 5) {
    for (int x = window.x_min; x <= window.x_max; x += 5)
      ASSERT_EQ(map->countsAt(x, y), countsByHand(iteration, test, item, x, y)) << x << " " << y;
  }
}

TEST(ScoreMap, IsNothingWhereNothingCanBeSearchedOrStopped) {
  const IterationTrace& first = *exampleTrace().iterations.front();
  EXPECT_FALSE(scoreMap(*exampleTrace().edges, first, -1));
  EXPECT_FALSE(scoreMap(*exampleTrace().edges, first, first.template_count));
  EXPECT_FALSE(scoreMap(EdgeMapTrace{}, first, 0));
  IterationTrace not_searched = first;
  not_searched.matches[0].searched = false;
  EXPECT_FALSE(scoreMap(*exampleTrace().edges, not_searched, 0));
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_FALSE(scoreMap(*exampleTrace().edges, first, 3, stopped.get_token()));
}

}  // namespace
}  // namespace boresight::sessions
