// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/worker_pool.h"

namespace boresight::sessions {

WorkerPool::WorkerPool(int workers) {
  for (int worker = 1; worker < workers; ++worker) {
    threads_.emplace_back([this, worker](const std::stop_token& ended) { serve(worker, ended); });
  }
}

WorkerPool::~WorkerPool() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void WorkerPool::run(int tasks, const RunTask& run_task, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  run_task_ = &run_task;
  stop_ = stop;
  next_ = 0;
  tasks_ = tasks;
  if (tasks > 1) begun_.notify_all();
  takeTasks(0, lock);
  done_.wait(lock, [this] { return busy_ == 0; });
  run_task_ = nullptr;
  stop_ = {};
}

void WorkerPool::serve(int worker, const std::stop_token& ended) {
  std::unique_lock lock(mutex_);
  while (begun_.wait(lock, ended, [this] { return run_task_ != nullptr && next_ < tasks_; }))
    takeTasks(worker, lock);
}

/// Called with the lock, which is released while a task runs.
void WorkerPool::takeTasks(int worker, std::unique_lock<std::mutex>& lock) {
  while (run_task_ != nullptr && next_ < tasks_) {
    if (stop_.stop_requested()) {
      next_ = tasks_;
      return;
    }
    const int task = next_++;
    const RunTask& run_task = *run_task_;
    ++busy_;
    lock.unlock();
    run_task(task, worker);
    lock.lock();
    --busy_;
  }
  if (busy_ == 0) done_.notify_one();
}

}  // namespace boresight::sessions
