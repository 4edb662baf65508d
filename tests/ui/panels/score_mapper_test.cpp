// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/score_mapper.h"

#include <vector>

#include <gtest/gtest.h>
#include <QtTest/QTest>

#include "tests/support/example_run.h"

namespace boresight::ui {
namespace {

class ScoreMapperTest : public testing::Test {
 protected:
  ScoreMapperTest() {
    QObject::connect(&mapper_, &ScoreMapper::ready, &mapper_,
                     [this](const ScoreMapper::MapPtr& map) { answers_.push_back(map); });
  }
  ScoreMapper::Request of(int index) const {
    const auto run = test::exampleRun();
    return {run->edges, run->iterations.front(), index};
  }

  ScoreMapper mapper_;
  std::vector<ScoreMapper::MapPtr> answers_;
};

TEST_F(ScoreMapperTest, AnAnswerThatCameTooLateIsDropped) {
  EXPECT_EQ(mapper_.request(of(1)), nullptr);
  QTest::qSleep(500);  // its answer waits for the event loop by now, most likely
  EXPECT_EQ(mapper_.request(of(2)), nullptr);
  ASSERT_TRUE(QTest::qWaitFor([this] { return !answers_.empty(); }, 20000));
  QTest::qWait(50);
  ASSERT_EQ(answers_.size(), 1u);
  const auto expected =
      sessions::scoreMap(*test::exampleRun()->edges, *test::exampleRun()->iterations.front(), 2);
  EXPECT_EQ(answers_.front()->counts, expected->counts);
  EXPECT_EQ(mapper_.request(of(2)), answers_.front()) << "known by now";
}

TEST_F(ScoreMapperTest, AnswersNothingAfterACancel) {
  EXPECT_EQ(mapper_.request(of(3)), nullptr);
  mapper_.cancel();
  QTest::qWait(500);
  EXPECT_TRUE(answers_.empty());
}

TEST_F(ScoreMapperTest, SaysSoWhereThereIsNoMap) {
  EXPECT_EQ(mapper_.request(of(100000)), nullptr);
  ASSERT_TRUE(QTest::qWaitFor([this] { return !answers_.empty(); }, 20000));
  EXPECT_EQ(answers_.front(), nullptr);
}

}  // namespace
}  // namespace boresight::ui
