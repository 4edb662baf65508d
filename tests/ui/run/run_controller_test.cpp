// SPDX-License-Identifier: Apache-2.0
#include "ui/run/run_controller.h"

#include <gtest/gtest.h>
#include <QtTest/QTest>

#include <vector>

#include "sessions/run/runner.h"
#include "tests/support/loaded_example.h"
#include "tests/ui/patience.h"

namespace boresight::ui {
namespace {

using sessions::StepUntil;

using test::kPatienceMs;

class RunControllerTest : public testing::Test {
 protected:
  RunControllerTest() {
    QObject::connect(&run_, &RunController::snapshotChanged, &run_, [this] {
      if (run_.snapshot()) counts_.push_back(run_.snapshot()->iterations.size());
    });
  }
  RunInputs inputs() const { return {case_, defaultProfile(), {}, {}}; }
  bool arrives(RunState state) {
    return QTest::qWaitFor([this, state] { return run_.state() == state; }, kPatienceMs);
  }
  /// Runs to the end with many stops on the way.
  void runHaltingly() {
    for (int stops = 0; stops < 1000 && run_.state() != RunState::kFinished; ++stops) {
      run_.advance(StepUntil::kEnd);
      QTest::qWait(5);
      run_.stop();
      ASSERT_TRUE(
          QTest::qWaitFor([this] { return run_.state() != RunState::kWorking; }, kPatienceMs));
    }
  }
  /// The case and a second image of the same rig, from the same place.
  RunInputs bothViews() const {
    sessions::SessionCase first = case_->source;
    first.rig = sessions::Rig{"pair", Pose()};
    sessions::SessionCase second = first;
    second.id += "-2";
    RunInputs both = inputs();
    both.one = sessions::loadCase(first);
    both.others = {second};
    return both;
  }

  std::shared_ptr<const sessions::LoadedCase> case_ = test::loadedExample("bc");
  RunController run_;
  std::vector<std::size_t> counts_;  ///< iterations of each snapshot
};

TEST_F(RunControllerTest, ShowsEveryIterationOnTheWayToTheEnd_AStopHaltsItAndChangesNoBit) {
  const auto headless =
      sessions::localize(case_->problem(), defaultProfile(), sessions::RecordLevel::kSummary);
  run_.reset(inputs());
  run_.advance(StepUntil::kEnd);
  ASSERT_TRUE(arrives(RunState::kFinished));
  EXPECT_EQ(run_.snapshot()->digest, headless.digest);
  for (std::size_t i = 0; i < run_.snapshot()->iterations.size(); ++i)
    EXPECT_NE(std::find(counts_.begin(), counts_.end(), i + 1), counts_.end()) << i;
  run_.reset(inputs());
  ASSERT_NO_FATAL_FAILURE(runHaltingly());
  EXPECT_EQ(run_.snapshot()->digest, headless.digest);
}

TEST_F(RunControllerTest, SeveralViewsAreRunAsOneAndAStopChangesNoBit) {
  const RunInputs both = bothViews();
  run_.reset(both);
  EXPECT_TRUE(run_.views().empty());
  ASSERT_NO_FATAL_FAILURE(runHaltingly());
  ASSERT_EQ(run_.views().size(), 2u);
  EXPECT_EQ(run_.snapshot(), run_.views().front());
  const auto views = sessions::loadViews(both.one, both.others);
  sessions::Runner expected(views->problem(), defaultProfile(), views->ids());
  expected.advance(StepUntil::kEnd);
  for (std::size_t v = 0; v < 2; ++v)
    EXPECT_EQ(run_.views()[v]->digest, expected.traces()[v].digest);
  run_.reset(inputs());
  EXPECT_TRUE(run_.views().empty());
}

TEST_F(RunControllerTest, AViewThatCannotBeReadIsOneSentence) {
  RunInputs both = bothViews();
  both.others[0].image.source.file = "/nowhere/second.png";
  QString message;
  QObject::connect(&run_, &RunController::failed, [&](const QString& text) { message = text; });
  run_.reset(both);
  run_.advance(StepUntil::kEnd);
  ASSERT_TRUE(arrives(RunState::kReady));
  EXPECT_TRUE(message.contains(QStringLiteral("/nowhere/second.png"))) << message.toStdString();
}

TEST_F(RunControllerTest, Reset_DropsTheRunningRun) {
  run_.reset(inputs());
  run_.advance(StepUntil::kEnd);
  run_.reset(inputs());
  EXPECT_EQ(run_.state(), RunState::kReady);
  counts_.clear();
  run_.advance(StepUntil::kStage);
  ASSERT_TRUE(arrives(RunState::kHalted));
  EXPECT_EQ(counts_, std::vector<std::size_t>{0}) << "the edges of the new run, nothing else";
  run_.reset({});
  EXPECT_EQ(run_.state(), RunState::kEmpty);
  run_.advance(StepUntil::kEnd);
  EXPECT_EQ(run_.state(), RunState::kEmpty);
}

}  // namespace
}  // namespace boresight::ui
