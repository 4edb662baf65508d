// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run_scrubber.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"

namespace boresight::ui {
namespace {

TEST(StageSteps, WalkThroughARunAndBackAgain) {
  const auto run = test::exampleRun();
  std::size_t stages = 0;
  for (const auto& iteration : run->iterations)
    stages += iteration->kind == IterationKind::kMatch ? 4 : 2;
  std::vector<RunCursor> way = {{-1, Stage::kFinished}};
  while (true) {
    const RunCursor next = nextStage(*run, way.back());
    if (next == way.back()) break;
    way.push_back(next);
    ASSERT_LE(way.size(), 1000u);
  }
  EXPECT_EQ(way.size(), stages + 1);
  EXPECT_EQ(way[1], (RunCursor{0, Stage::kRender}));
  EXPECT_EQ(way[2], (RunCursor{0, Stage::kTemplates}));
  EXPECT_EQ(way[3], (RunCursor{0, Stage::kMatch}));
  EXPECT_EQ(way[4], (RunCursor{0, Stage::kFinished}));
  for (std::size_t i = way.size() - 1; i > 0; --i)
    EXPECT_EQ(previousStage(*run, way[i]), way[i - 1]) << i;
  EXPECT_EQ(previousStage(*run, way[0]), way[0]);
}

TEST(StageSteps, EndWhereAnIterationUnderWayIs) {
  sessions::IterationTrace one = *test::exampleRun()->iterations.front();
  one.reached = Stage::kTemplates;
  EXPECT_EQ(stagesOf(one), (std::vector<Stage>{Stage::kRender, Stage::kTemplates}));
  EXPECT_EQ(shownStage(stagesOf(one), Stage::kFinished), 1);
  EXPECT_EQ(shownStage(stagesOf(one), Stage::kRender), 0);
}

}  // namespace
}  // namespace boresight::ui
