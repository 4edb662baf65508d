// SPDX-License-Identifier: Apache-2.0
// What matches say about the templates that they are of.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/localizer.h"
#include "tests/core/localizer/rail_scene.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

double marginOf(const Match& match) {
  if (!match.peak.has_second) return 2.0;
  return whsScore(match.peak.counts, match.norms) - whsScore(match.peak.second_counts, match.norms);
}

void finishStage(Localizer& localizer, Stage stage) {
  StepReport made;
  do {
    made = localizer.step();
  } while (!(made.stage == stage && made.stage_complete) && !made.finished);
  ASSERT_FALSE(made.finished);
}

std::span<const Match> matchesOf(const Iteration& iteration) {
  return iteration.matches.matches.first(static_cast<std::size_t>(iteration.matches.count));
}

TEST(LocalizerLearning, IndistinctMatchesAreNotUsedForThePose) {
  LocalizerOptions options = defaultProfile();
  options.templates.min_margin = 0.15;
  const Case scene = railCase(Ends::kSeen, 0.25, 1.7, 4);
  OwnedRun run(scene.problem(), options);
  finishStage(run.localizer, Stage::kMatch);
  const Iteration& now = *run.localizer.workspace().iteration;
  int dropped = 0, used = 0;
  for (const Match& match : matchesOf(now)) {
    EXPECT_EQ(match.dropped, match.searched && marginOf(match) < 0.15);
    dropped += match.dropped ? 1 : 0;
    used += match.searched && !match.dropped ? 1 : 0;
  }
  EXPECT_GT(dropped, 5);
  EXPECT_EQ(now.correspondence_count, used);
  for (std::int32_t i = 0; i < now.correspondence_count; ++i) {
    const auto index = static_cast<std::size_t>(now.template_of[static_cast<std::size_t>(i)]);
    EXPECT_FALSE(matchesOf(now)[index].dropped);
  }
}

TEST(LocalizerLearning, WhereHardlyAnyIsDistinctAllAreUsed) {
  LocalizerOptions options = defaultProfile();
  options.templates.min_margin = 1.9;
  const Case scene = stationCase(4);
  OwnedRun run(scene.problem(), options);
  finishStage(run.localizer, Stage::kMatch);
  for (const Match& match : matchesOf(*run.localizer.workspace().iteration))
    EXPECT_FALSE(match.dropped);
}

/// By brute force: no template of the second iteration is near what failed in the first.
TEST(LocalizerLearning, LaterTemplatesKeepAwayFromWhatFailed) {
  LocalizerOptions options = defaultProfile();
  options.templates.min_margin = 0.1;
  options.templates.learn = true;
  const Case scene = railCase(Ends::kSeen, 0.25, 1.7, 4);
  OwnedRun run(scene.problem(), options);
  finishStage(run.localizer, Stage::kPose);
  while (!run.localizer.isBetweenIterations()) (void)run.localizer.step();
  const Iteration& first = *run.localizer.workspace().iteration;
  std::vector<Eigen::Vector3d> failed_m;
  for (std::size_t i = 0; i < matchesOf(first).size(); ++i)
    if (matchesOf(first)[i].dropped)
      failed_m.push_back(first.templates.templates[i].point_in_station_m);
  if (2 * first.pnp.inlier_count >= first.correspondence_count) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(first.correspondence_count); ++i)
      if (first.pnp.inlier[i] == 0)
        failed_m.push_back(first.templates.templates[static_cast<std::size_t>(first.template_of[i])]
                               .point_in_station_m);
  }
  ASSERT_GT(failed_m.size(), 3u);
  finishStage(run.localizer, Stage::kTemplates);
  const Iteration& second = *run.localizer.workspace().iteration;
  ASSERT_GT(second.templates.count, 6);
  for (std::int32_t i = 0; i < second.templates.count; ++i) {
    const Template& item = second.templates.templates[static_cast<std::size_t>(i)];
    for (const Eigen::Vector3d& point_m : failed_m) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(
          project(second.render.camera, second.render.camera_from_station * point_m, pixel));
      EXPECT_GE((pixel - Eigen::Vector2d(item.center_x, item.center_y)).norm(),
                0.25 * second.templates.side_px);
    }
  }
}

TEST(LocalizerLearning, HardlyMovesAPoseThatWasRight) {
  const Case scene = stationCase(6);
  LocalizerOptions options = defaultProfile();
  options.templates.learn = true;
  OwnedRun plain(scene.problem(), defaultProfile()), learning(scene.problem(), options);
  plain.finish();
  learning.finish();
  const PoseError apart = poseError(scene.solid, plain.localizer.workspace().camera_from_station,
                                    learning.localizer.workspace().camera_from_station);
  EXPECT_LT(apart.centre_m, 2e-5);
  EXPECT_LT(apart.angle_rad, 2e-4);
}

}  // namespace
}  // namespace boresight::test
