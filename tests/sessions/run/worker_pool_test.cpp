// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "sessions/run/worker_pool.h"

namespace boresight::sessions {
namespace {

TEST(WorkerPool, Run_RunsEveryTaskOnce) {
  for (const int workers : {1, 2, 3, 8}) {
    WorkerPool pool(workers);
    EXPECT_EQ(pool.workers(), workers);
    for (const int tasks : {0, 1, 2, 7, 1000}) {
      std::vector<std::atomic<int>> done(static_cast<std::size_t>(tasks));
      pool.run(tasks, [&](int task, int worker) {
        EXPECT_GE(worker, 0);
        EXPECT_LT(worker, workers);
        ++done[static_cast<std::size_t>(task)];
      });
      for (const std::atomic<int>& count : done) EXPECT_EQ(count, 1);
    }
  }
}

TEST(WorkerPool, Run_NeverGivesAWorkerTwoTasksAtOnce) {
  WorkerPool pool(4);
  std::vector<int> busy(4, 0);  // not atomic: a worker's own
  for (int round = 0; round < 200; ++round) {
    pool.run(20, [&](int, int worker) {
      const auto own = static_cast<std::size_t>(worker);
      EXPECT_EQ(busy[own]++, 0);
      std::this_thread::yield();
      --busy[own];
    });
  }
}

TEST(WorkerPool, Run_UsesAllThreads) {
  constexpr int kWorkers = 3;
  WorkerPool pool(kWorkers);
  std::atomic<int> arrived = 0;
  // Each waits for all the others: one that did two tasks would wait for ever.
  pool.run(kWorkers, [&](int, int) {
    ++arrived;
    while (arrived < kWorkers) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, kWorkers);
}

TEST(WorkerPool, Run_AfterStop_StartsNoTask) {
  WorkerPool pool(3);
  std::stop_source source;
  std::atomic<int> done = 0;
  pool.run(
      1000,
      [&](int task, int) {
        if (task == 5) source.request_stop();
        while (task > 5 && !source.stop_requested()) std::this_thread::yield();
        ++done;
      },
      source.get_token());
  EXPECT_GE(done, 6);
  EXPECT_LE(done, 6 + 2);
  const int before = done;
  pool.run(
      10, [&](int, int) { ++done; }, source.get_token());
  EXPECT_EQ(done, before);
  pool.run(10, [&](int, int) { ++done; });
  EXPECT_EQ(done, before + 10);
}

}  // namespace
}  // namespace boresight::sessions
