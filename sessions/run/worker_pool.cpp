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

void WorkerPool::run(int pieces, const Work& work, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  stop_ = stop;
  next_ = 0;
  pieces_ = pieces;
  if (pieces > 1) begun_.notify_all();
  takePieces(0, lock);
  done_.wait(lock, [this] { return busy_ == 0; });
  work_ = nullptr;
  stop_ = {};
}

void WorkerPool::serve(int worker, const std::stop_token& ended) {
  std::unique_lock lock(mutex_);
  while (begun_.wait(lock, ended, [this] { return work_ != nullptr && next_ < pieces_; }))
    takePieces(worker, lock);
}

/// Called with the lock, which is released while a piece is worked on.
void WorkerPool::takePieces(int worker, std::unique_lock<std::mutex>& lock) {
  while (work_ != nullptr && next_ < pieces_) {
    if (stop_.stop_requested()) {
      next_ = pieces_;
      return;
    }
    const int piece = next_++;
    const Work& work = *work_;
    ++busy_;
    lock.unlock();
    work(piece, worker);
    lock.lock();
    --busy_;
  }
  if (busy_ == 0) done_.notify_one();
}

}  // namespace boresight::sessions
