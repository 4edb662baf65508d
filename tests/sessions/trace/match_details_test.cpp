// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/match_details.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

using test::exampleTrace;

TEST(FullImagePixel, IsTheCentreOfTheBlockThatAPixelCovers) {
  EXPECT_EQ(fullImagePixel(3.0, 4.0, 0), Eigen::Vector2d(3.0, 4.0));
  // Pixel 0 of level 2 covers pixels 0 .. 3.
  EXPECT_EQ(fullImagePixel(0.0, 1.0, 2), Eigen::Vector2d(1.5, 5.5));
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
    if (!std::isnan(match_details.margin)) {
      EXPECT_GE(match_details.margin, 0.0);
      EXPECT_LE(match_details.margin, 1.0);
    }
  }
  EXPECT_EQ(searched, first.searched_count);
  EXPECT_EQ(solved, first.correspondence_count);
  EXPECT_EQ(inliers, first.pnp.inlier_count);
  EXPECT_EQ(best, first.best_score);
  EXPECT_NEAR(sum / searched, first.mean_score, 1e-12);
}

TEST(MatchDetails, PlaceAMatchWhereItsCorrespondenceIs) {
  const IterationTrace& first = *exampleTrace().iterations.front();
  const std::vector<MatchDetails> all = matchDetails(first);
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

}  // namespace
}  // namespace boresight::sessions
