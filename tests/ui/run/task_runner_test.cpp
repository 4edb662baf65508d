// SPDX-License-Identifier: Apache-2.0
#include "ui/run/task_runner.h"

#include <gtest/gtest.h>
#include <QStringList>
#include <QtTest/QTest>

#include <cstddef>
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

template <class... Arguments>
concept CanBeQueued = requires(TaskRunner runner, Arguments... arguments) {
  runner.queue(arguments...);
};

using MakesInt = int (*)(const std::stop_token&);
using TakesInt = void (*)(int);
using TakesText = void (*)(const QString&);
static_assert(CanBeQueued<MakesInt, TakesInt, TakesText>);
static_assert(!CanBeQueued<MakesInt, TakesInt>, "who receives the failure?");
static_assert(!CanBeQueued<MakesInt, TakesInt, std::nullptr_t>);

/// A runner, what its tasks returned, and a gate that holds a task until it is opened.
class TaskRunnerTest : public testing::Test {
 protected:
  bool rests() {
    return QTest::qWaitFor([this] { return !runner_.isBusy(); }, kPatienceMs);
  }
  static auto valueOf(int value) {
    return [value](const std::stop_token&) { return value; };
  }
  /// Waits for the gate, then reports whether it was asked to stop.
  auto gated() {
    return [gate = gate_.get_future().share()](const std::stop_token& stop) {
      gate.wait();
      return stop.stop_requested() ? 1000 : 2000;
    };
  }

  std::promise<void> gate_;
  std::vector<int> taken_;
  const std::function<void(int)> take_ = [this](int result) { taken_.push_back(result); };
  QStringList failures_;
  const std::function<void(const QString&)> fail_ = [this](const QString& message) {
    failures_ << message;
  };
  const TaskKind first_;
  const TaskKind second_;
  const TaskKind third_;
  TaskRunner runner_;
};

TEST_F(TaskRunnerTest, QueuedTasks_AreAllTakenInTheirOrderOnTheOwnersThread) {
  const auto current = std::this_thread::get_id();
  bool here_as_well = true;
  for (int i = 0; i < 20; ++i) {
    runner_.queue(
        [i, current](const std::stop_token&) {
          return std::this_thread::get_id() == current ? -1 : i;
        },
        [&](int result) {
          here_as_well = here_as_well && std::this_thread::get_id() == current;
          taken_.push_back(result);
        },
        fail_);
  }
  ASSERT_TRUE(rests());
  std::vector<int> expected(20);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(taken_, expected);
  EXPECT_TRUE(here_as_well);
}

TEST_F(TaskRunnerTest, OfOneKindOnlyTheNewestCounts) {
  runner_.replace(first_, gated(), take_, fail_);
  for (int i = 0; i < 5; ++i) runner_.replace(second_, valueOf(i), take_, fail_);
  runner_.replace(first_, valueOf(7), take_, fail_);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, (std::vector<int>{4, 7}));
}

TEST_F(TaskRunnerTest, CancelledTask_IsNotDelivered) {
  runner_.replace(first_, gated(), take_, fail_);
  runner_.replace(second_, valueOf(1), take_, fail_);
  runner_.replace(third_, valueOf(2), take_, fail_);
  runner_.cancel(first_);
  runner_.cancel(second_);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{2});
}

TEST_F(TaskRunnerTest, StoppedTask_IsDelivered) {
  runner_.replace(first_, gated(), take_, fail_);
  runner_.stop(first_);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{1000});
}

TEST_F(TaskRunnerTest, AStopReachesATaskThatStillWaits) {
  runner_.replace(first_, gated(), take_, fail_);
  runner_.replace(
      second_, [](const std::stop_token& stop) { return stop.stop_requested() ? 1 : 0; }, take_,
      fail_);
  runner_.stop(second_);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, (std::vector<int>{2000, 1}));
}

TEST_F(TaskRunnerTest, ReportsOnTheWayAndNothingMoreOnceCancelled) {
  const auto gate = gate_.get_future().share();
  const auto work = [this, gate](const std::stop_token&, const TaskRunner::Report& report) {
    report([this] { taken_.push_back(1); });
    gate.wait();
    report([this] { taken_.push_back(2); });
  };
  runner_.replace(first_, work, fail_);
  ASSERT_TRUE(QTest::qWaitFor([this] { return !taken_.empty(); }, kPatienceMs));
  EXPECT_TRUE(runner_.isBusy());
  runner_.cancel(first_);
  gate_.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{1});
}

TEST_F(TaskRunnerTest, FailureOfAnyKind_IsReceivedAsASentence_UnlessTheTaskWasDropped) {
  const auto throwing = [](const std::stop_token&) -> int { throw std::runtime_error("no luck"); };
  runner_.queue(throwing, take_, fail_);
  runner_.queue([](const std::stop_token&) -> int { throw std::bad_alloc(); }, take_, fail_);
  runner_.queue([](const std::stop_token&) -> int { throw 5; }, take_, fail_);
  runner_.queue(
      valueOf(2), [](int) { throw std::runtime_error("not taken"); }, fail_);
  runner_.replace(first_, throwing, take_, fail_);
  runner_.cancel(first_);
  runner_.queue(valueOf(3), take_, fail_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(taken_, std::vector<int>{3});
  ASSERT_EQ(failures_.size(), 4);
  EXPECT_EQ(failures_[3], QStringLiteral("not taken"));
  EXPECT_EQ(failures_[0], QStringLiteral("no luck"));
  EXPECT_TRUE(failures_[1].contains(QStringLiteral("Not enough memory")));
  EXPECT_FALSE(failures_[2].isEmpty());
}

/// Its owner was told of two ends: that of the failure, and that of the task.
TEST_F(TaskRunnerTest, TaskOfWhichAReportThrows_EndsOnceAndIsStopped) {
  bool stopped = false;
  const auto work = [&](const std::stop_token& stop, const TaskRunner::Report& report) {
    report([] { throw std::runtime_error("no luck"); });
    while (!stop.stop_requested()) std::this_thread::yield();
    stopped = true;
    report([this] { taken_.push_back(1); });
    throw std::runtime_error("once more");
  };
  runner_.queue(work, fail_);
  runner_.queue(work, [](const QString&) { throw std::runtime_error("the receiver, too"); });
  runner_.queue(valueOf(2), take_, fail_);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(stopped);
  EXPECT_EQ(failures_, QStringList{QStringLiteral("no luck")});
  EXPECT_EQ(taken_, std::vector<int>{2});
}

TEST_F(TaskRunnerTest, EndOfAllRunners_DropsWhatWaitsAndIsKnown) {
  std::promise<void> begun;
  runner_.queue(
      [&](const std::stop_token&) {
        begun.set_value();
        gate_.get_future().wait();
        return 1;
      },
      take_, fail_);
  runner_.queue(valueOf(2), take_, fail_);
  begun.get_future().wait();
  TaskRunner::endAll();
  EXPECT_FALSE(TaskRunner::allEnded()) << "it is as if a file were being read";
  runner_.queue(valueOf(3), take_, fail_);
  gate_.set_value();
  EXPECT_TRUE(QTest::qWaitFor(&TaskRunner::allEnded, kPatienceMs));
  QApplication::processEvents();
  EXPECT_TRUE(taken_.empty());
}

TEST(TaskRunner, Destruction_WhileATaskRuns_IsSafe) {
  std::promise<void> begun;
  TaskRunner runner;
  const auto work = [&begun](const std::stop_token& stop, const TaskRunner::Report& report) {
    begun.set_value();
    while (!stop.stop_requested()) std::this_thread::yield();
    report([] { FAIL() << "its owner is gone"; });
  };
  runner.queue(work, [](const QString&) {});
  begun.get_future().wait();
}

}  // namespace
}  // namespace boresight::ui
