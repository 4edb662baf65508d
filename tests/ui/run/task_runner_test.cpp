// SPDX-License-Identifier: Apache-2.0
#include "ui/run/task_runner.h"

#include <gtest/gtest.h>
#include <QStringList>
#include <QtTest/QTest>

#include <functional>
#include <future>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/ui/patience.h"

namespace boresight::ui {
namespace {

using test::kPatienceMs;

/// A runner, what its tasks gave, and a gate that holds a task until it is opened.
class TaskRunnerTest : public testing::Test {
 protected:
  TaskRunnerTest() {
    QObject::connect(&runner_, &TaskRunner::failed, &runner_,
                     [this](const QString& message) { failures_ << message; });
  }
  bool rests() {
    return QTest::qWaitFor([this] { return !runner_.isBusy(); }, kPatienceMs);
  }
  void startValue(const QString& key, int value) {
    runner_.start(
        key, [value](const std::stop_token&) { return value; }, take_);
  }
  /// A task that waits for the gate, then reports whether it was asked to stop.
  void startGated(const QString& key) {
    runner_.start(
        key,
        [gate = gate_.get_future().share()](const std::stop_token& stop) {
          gate.wait();
          return stop.stop_requested() ? 1000 : 2000;
        },
        take_);
  }

  std::promise<void> gate_;
  std::vector<int> taken_;
  const std::function<void(int)> take_ = [this](int result) { taken_.push_back(result); };
  QStringList failures_;
  TaskRunner runner_;
};

TEST_F(TaskRunnerTest, TakesValuesInTheirOrderOnTheOwnersThread) {
  const auto current = std::this_thread::get_id();
  bool here_as_well = true;
  for (int i = 0; i < 20; ++i) {
    runner_.start(
        QString::number(i),
        [i, current](const std::stop_token&) {
          return std::this_thread::get_id() == current ? -1 : i;
        },
        [&](int result) {
          here_as_well = here_as_well && std::this_thread::get_id() == current;
          taken_.push_back(result);
        });
  }
  ASSERT_TRUE(rests());
  std::vector<int> expected(20);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(taken_, expected);
  EXPECT_TRUE(here_as_well);
}

TEST_F(TaskRunnerTest, OfOneKindOnlyTheNewestCounts) {
  startGated(QStringLiteral("gated"));
  for (int i = 0; i < 5; ++i) startValue(QStringLiteral("value"), i);
  startValue(QStringLiteral("gated"), 7);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, (std::vector<int>{4, 7}));
}

TEST_F(TaskRunnerTest, CancelledTask_IsNotDelivered) {
  startGated(QStringLiteral("gated"));
  startValue(QStringLiteral("value"), 1);
  startValue(QStringLiteral("other"), 2);
  runner_.cancel(QStringLiteral("gated"));
  runner_.cancel(QStringLiteral("value"));
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{2});
}

TEST_F(TaskRunnerTest, StoppedTask_IsDelivered) {
  startGated(QStringLiteral("gated"));
  runner_.stop(QStringLiteral("gated"));
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{1000});
}

TEST_F(TaskRunnerTest, AStopReachesATaskThatStillWaits) {
  startGated(QStringLiteral("first"));
  runner_.start(
      QStringLiteral("second"),
      [](const std::stop_token& stop) { return stop.stop_requested() ? 1 : 0; }, take_);
  runner_.stop(QStringLiteral("second"));
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, (std::vector<int>{2000, 1}));
}

TEST_F(TaskRunnerTest, ReportsOnTheWayAndNothingMoreOnceCancelled) {
  const auto gate = gate_.get_future().share();
  runner_.run(QStringLiteral("long"),
              [this, gate](const std::stop_token&, const TaskRunner::Report& report) {
                report([this] { taken_.push_back(1); });
                gate.wait();
                report([this] { taken_.push_back(2); });
              });
  ASSERT_TRUE(QTest::qWaitFor([this] { return !taken_.empty(); }, kPatienceMs));
  EXPECT_TRUE(runner_.isBusy());
  runner_.cancel(QStringLiteral("long"));
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{1});
}

TEST_F(TaskRunnerTest, SaysWhyATaskFailedAndGoesOn) {
  const auto throwing = [](const std::stop_token&) -> int { throw std::runtime_error("no luck"); };
  runner_.start(QStringLiteral("bad"), throwing, take_);
  runner_.start(
      QStringLiteral("large"), [](const std::stop_token&) -> int { throw std::bad_alloc(); },
      [](int) {});
  runner_.start(QStringLiteral("dropped"), throwing, [](int) {});
  runner_.cancel(QStringLiteral("dropped"));
  startValue(QStringLiteral("good"), 3);
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{3});
  ASSERT_EQ(failures_.size(), 2);
  EXPECT_EQ(failures_[0], QStringLiteral("no luck"));
  EXPECT_TRUE(failures_[1].contains(QStringLiteral("Not enough memory")));
}

TEST(TaskRunner, Destruction_WhileATaskRuns_IsSafe) {
  std::promise<void> begun;
  TaskRunner runner;
  runner.run(QStringLiteral("endless"),
             [&begun](const std::stop_token& stop, const TaskRunner::Report& report) {
               begun.set_value();
               while (!stop.stop_requested()) std::this_thread::yield();
               report([] { FAIL() << "its owner is gone"; });
             });
  begun.get_future().wait();
}

}  // namespace
}  // namespace boresight::ui
