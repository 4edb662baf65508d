// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace boresight::sessions {

/// Threads that share independent tasks and sleep in between. The calling thread is worker 0.
class WorkerPool {
 public:
  /// Throws std::system_error when no thread can be created.
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return static_cast<int>(threads_.size()) + 1; }

  using RunTask = std::function<void(int task, int worker)>;  ///< must not throw
  /// Calls `run_task` once for each task 0 ... tasks - 1, in order, and returns when all calls have
  /// returned. After a stop no further task starts.
  void run(int tasks, const RunTask& run_task, const std::stop_token& stop = {});

 private:
  void serve(int worker, const std::stop_token& ended);
  void takeTasks(int worker, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable_any begun_;
  std::condition_variable done_;
  const RunTask* run_task_ = nullptr;  ///< while tasks are left
  std::stop_token stop_;
  int next_ = 0;
  int tasks_ = 0;
  int busy_ = 0;                       ///< calls that have not returned
  std::vector<std::jthread> threads_;  ///< declared last: the threads use the other members
};

}  // namespace boresight::sessions
