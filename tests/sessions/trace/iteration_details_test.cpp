// SPDX-License-Identifier: Apache-2.0
// What is shown of an iteration of a recorded run: score maps, matches, edge samples.
#include "sessions/trace/match_details.h"
#include "sessions/trace/sample_statistics.h"
#include "sessions/trace/score_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

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

TEST(AtFullResolution, IsTheCentreOfTheBlockThatAPixelCovers) {
  EXPECT_EQ(atFullResolution({3.0, 4.0}, 0), Eigen::Vector2d(3.0, 4.0));
  // Pixel 0 of level 2 covers pixels 0 .. 3.
  EXPECT_EQ(atFullResolution({0.0, 1.0}, 2), Eigen::Vector2d(1.5, 5.5));
}

TEST(MatchDetails, EqualTheRecordedIteration) {
  const IterationTrace& first = *exampleTrace().iterations.front();
  const std::vector<MatchDetails> all = matchDetails(first);
  ASSERT_EQ(all.size(), first.templates.size());
  ASSERT_GT(all.size(), 10u);
  int searched = 0, inliers = 0, solved = 0;
  double best = 0.0, sum = 0.0;
  for (const MatchDetails& match_details : all) {
    searched += match_details.searched ? 1 : 0;
    inliers += match_details.inlier ? 1 : 0;
    solved += match_details.solved ? 1 : 0;
    EXPECT_EQ(match_details.searched, match_details.solved);
    if (!match_details.searched) continue;
    best = std::max(best, match_details.score);
    sum += match_details.score;
    EXPECT_NEAR(match_details.edge_share + match_details.empty_share, match_details.score, 1e-12);
    EXPECT_FALSE(match_details.margin < 0.0 || match_details.margin > 1.0) << "unless not a number";
  }
  EXPECT_EQ(searched, first.searched_count);
  EXPECT_EQ(solved, first.correspondence_count);
  EXPECT_EQ(inliers, first.pnp.inlier_count);
  EXPECT_EQ(best, first.best_score);
  EXPECT_NEAR(sum / searched, first.mean_score, 1e-12);
  for (std::size_t i = 0; i < first.correspondences.size(); ++i) {
    const MatchDetails& match_details = all[static_cast<std::size_t>(first.template_of[i])];
    EXPECT_EQ(match_details.found_px, first.correspondences[i].pixel);
    EXPECT_EQ(match_details.point_in_station_m, first.correspondences[i].point_in_station_m);
    EXPECT_EQ(match_details.residual_px, first.pnp.residual_px[i]);
  }
}

TEST(MatchDetails, StagesNotReached_AreUnknown) {
  IterationTrace early = *exampleTrace().iterations.front();
  early.reached = Stage::kTemplates;
  early.matches.clear();
  for (const MatchDetails& match_details : matchDetails(early)) {
    EXPECT_FALSE(match_details.searched);
    EXPECT_FALSE(match_details.solved);
    EXPECT_FALSE(match_details.hasLowMargin());
    EXPECT_TRUE(std::isnan(match_details.score));
    EXPECT_TRUE(std::isnan(match_details.found_px.x()));
    EXPECT_TRUE(std::isnan(match_details.residual_px));
  }
}

EdgeSample sampleOf(double residual_px, double weight, std::uint8_t kind) {
  EdgeSample sample;
  sample.residual_px = residual_px;
  sample.gradient = 5.0;
  sample.weight = weight;
  sample.kind = kind;
  return sample;
}

TEST(SampleStatistics, CountByKindAndBin) {
  IterationTrace iteration;
  iteration.threshold_px = 1.0;
  iteration.refinement.samples = {sampleOf(0.0, 0.9, kEdgeCrease), sampleOf(-0.9, 0.2, kEdgeCrease),
                                  sampleOf(5.0, 0.0, kEdgeOccluding | kEdgeCrease),
                                  sampleOf(0.1, 0.8, kEdgeBorder | kEdgeOccluding),
                                  EdgeSample{}};  // the last: nothing found
  const SampleStatistics statistics = sampleStatistics(iteration, 5);
  EXPECT_EQ(statistics.all.places, 5);
  EXPECT_EQ(statistics.all.found, 4);
  EXPECT_EQ(statistics.all.used, 2);
  EXPECT_EQ(statistics.creases.places, 3);
  EXPECT_EQ(statistics.creases.found, 2);
  EXPECT_EQ(statistics.occluding.found, 1);
  EXPECT_EQ(statistics.border.used, 1);
  EXPECT_EQ(statistics.found_in_bin, (std::vector<std::int32_t>{1, 0, 2, 0, 1}));
  EXPECT_EQ(statistics.used_in_bin, (std::vector<std::int32_t>{0, 0, 2, 0, 0}));
  EXPECT_DOUBLE_EQ(statistics.all.foundShare(), 0.8);
  const SampleStatistics none = sampleStatistics(IterationTrace{}, 3);
  EXPECT_EQ(none.all.places, 0);
  EXPECT_EQ(none.all.foundShare(), 0.0);
}

TEST(SampleStatistics, AgreeWithWhatTheRunCounted) {
  const IterationTrace& last = *exampleTrace().iterations.back();
  ASSERT_EQ(last.kind, IterationKind::kRefine);
  const SampleStatistics statistics = sampleStatistics(last, 21);
  EXPECT_EQ(statistics.all.places, last.refinement.sample_count);
  EXPECT_EQ(statistics.all.found, last.refinement.found_count);
  EXPECT_EQ(statistics.all.used, last.refinement.used_count);
  EXPECT_EQ(std::accumulate(statistics.found_in_bin.begin(), statistics.found_in_bin.end(), 0),
            statistics.all.found);
  EXPECT_EQ(statistics.creases.places + statistics.occluding.places + statistics.border.places,
            statistics.all.places);
}

}  // namespace
}  // namespace boresight::sessions
